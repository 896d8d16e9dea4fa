"""SLAM methods on sequences of Gloam, and their benchmark (docs/slam.md)."""
