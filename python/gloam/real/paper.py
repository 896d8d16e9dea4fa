"""Table of section IV-A of the paper (simulation and reality), as data for comparison."""

from __future__ import annotations

CITATION = (
    "Jonathan Embley-Riches, Jianwei Liu, Simon Julier, Dimitrios Kanoulas: Unreal Robotics Lab: A High-Fidelity "
    "Robotics Simulator with Advanced Physics and Rendering. arXiv:2504.14135, section IV-A."
)
# (scene, KL divergence, cosine similarity), one pair of images each; the mean as printed.
TABLE = (("office hallway", 0.4679, 0.7157), ("flat hallway", 0.4435, 0.7231), ("bedroom", 0.5103, 0.6895), ("mean", 0.4739, 0.7094))

DIFFERENCES = (
    "The paper compares one pair of images per scene, three pairs in all, without intervals. The numbers here are means over all "
    "pairs, or over sets, with intervals.",
    "The paper does not name the network, layer or class distribution behind its two numbers; it mentions CLIP and the EfficientNet-B0 "
    "of ViNT, which was trained on robots’ images. Cosine similarities and divergences of different networks cannot be compared "
    "with each other: read them beside the halves of the real images and the baselines in the same table.",
    "The weights of CLIP and of ViNT’s encoder are in no package. With your own checkpoints, convert them (docs/realism.md) for the "
    "paper’s networks.",
    "The paper’s formula of the divergence has neither a temperature nor smoothing. Both are stated above; the divergence falls as "
    "either grows.",
    "The paper’s photographs are not published, so its pairs cannot be measured again.",
    "The paper’s EigenCAM projects the features without their mean, which shifts the map by a constant; here the projection is centred "
    "and its positive part is shown.",
)
