"""Gait-conditioned velocity tracking of robots with legs: one training for all robots in training/tasks.py."""
