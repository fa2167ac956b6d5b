"""Figures: functions from results to plotly figures as plain data."""
