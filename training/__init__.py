"""Training of the networks in assets/policies: MuJoCo MJX, PPO in JAX, export to ONNX (training/README.md)."""
