"""Networks of planners: preparation of images, and deterministic evaluation of ONNX files (docs/navigation_networks.md)."""
