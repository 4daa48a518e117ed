"""Surfaces of CAD models and of formulas, evaluated in blocks."""
