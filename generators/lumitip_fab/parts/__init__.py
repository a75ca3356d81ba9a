"""Printed parts, in build123d. Its import takes seconds: only workers import these."""
