"""Training of Gloam's own goal-image navigation policy: routes, images, network, publication (README.md)."""
