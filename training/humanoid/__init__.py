"""Velocity tracking of the humanoid in assets/robots/humanoid."""
