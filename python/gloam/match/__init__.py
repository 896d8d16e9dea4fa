"""The camera of a photograph in a scene, from pairs of a pixel and a scene point: pose, lens, exposure (docs/match.md)."""
