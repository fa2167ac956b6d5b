"""Forces that manufacturing errors lock into over-constrained mechanisms."""
