"""Gait-conditioned velocity tracking of the quadruped in assets/robots/quadruped."""
