"""The comparison of Azulay et al. 2014: four machines on a circular guide, and a prototype."""
