"""Benchmark of visual navigation: `gloam bench nav` (docs/navigation.md)."""
