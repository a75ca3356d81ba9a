"""Random boards of both fingers: drawn, routed, and judged by KiCad."""
