"""Several parts together: assembly, whole system, exploded drawings, robot description."""
