"""Comparison of simulated images with photographs: `gloam bench real` and `gloam real` (docs/realism.md)."""
