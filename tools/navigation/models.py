"""The networks of GNM, ViNT and NoMaD in PyTorch, with the names of parameters that the published checkpoints have.

Sources of the architectures and names: robodhruv/visualnav-transformer (train/vint_train/models, train/config);
torchvision's MobileNetV2 (Sandler et al. 2018, arXiv:1801.04381); efficientnet_pytorch's EfficientNet-B0 (Tan and Le 2019,
arXiv:1905.11946); the conditional U-Net of Diffusion Policy (Chi et al. 2023, arXiv:2303.04137) in unet.py.

All modules are for evaluation alone: dropout and stochastic depth of training are left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import torch
from backbones import EfficientNet, Norm, batch_norm, group_norm, mobile_net
from torch import Tensor, nn
from torch.nn import functional
from unet import ConditionalUnet


def waypoints_of(raw: Tensor, count: int) -> Tensor:
    """(1, count, 4) x, y, cos, sin from (1, 4 count): positions are sums of steps, directions get a length of 1."""
    steps = raw.reshape(raw.shape[0], count, 4)
    return torch.cat([torch.cumsum(steps[:, :, :2], 1), functional.normalize(steps[:, :, 2:], dim=-1)], -1)


class Gnm(nn.Module):
    """GNM (arXiv:2210.03370): MobileNetV2 for the images, another one for images and goal, and layers for both."""

    def __init__(self, context_size: int = 5, count: int = 5) -> None:
        super().__init__()
        self.count = count
        self.obs_mobilenet = mobile_net(3 * (context_size + 1))
        self.goal_mobilenet = mobile_net(3 * (context_size + 2))
        self.compress_observation = nn.Sequential(nn.Linear(1280, 1024), nn.ReLU())
        self.compress_goal = nn.Sequential(nn.Linear(1280, 1024), nn.ReLU(), nn.Linear(1024, 1024), nn.ReLU())
        self.linear_layers = nn.Sequential(nn.Linear(2048, 256), nn.ReLU(), nn.Linear(256, 32), nn.ReLU())
        self.dist_predictor = nn.Sequential(nn.Linear(32, 1))
        self.action_predictor = nn.Sequential(nn.Linear(32, 4 * count))

    def forward(self, obs_img: Tensor, goal_img: Tensor) -> tuple[Tensor, Tensor]:
        """(1, 1) distance and (1, count, 4) waypoints."""
        seen = self.compress_observation(self.obs_mobilenet(obs_img).mean((2, 3)))
        goal = self.compress_goal(self.goal_mobilenet(torch.cat([obs_img, goal_img], 1)).mean((2, 3)))
        joint = self.linear_layers(torch.cat([seen, goal], 1))
        return self.dist_predictor(joint), waypoints_of(self.action_predictor(joint), self.count)


class PositionalEncoding(nn.Module):
    """Adds sines and cosines of the place in the sequence (Vaswani et al. 2017, arXiv:1706.03762)."""

    pos_enc: Tensor

    def __init__(self, width: int, length: int) -> None:
        super().__init__()
        place = torch.arange(length, dtype=torch.float32)[:, None]
        rate = torch.exp(torch.arange(0, width, 2, dtype=torch.float32) * (-math.log(10000.0) / width))
        table = torch.stack([torch.sin(place * rate), torch.cos(place * rate)], -1).reshape(1, length, width)
        self.register_buffer("pos_enc", table)

    def forward(self, tokens: Tensor) -> Tensor:
        """The tokens, (n, length, width), with their places."""
        return tokens + self.pos_enc


class Attention(nn.Module):
    """Self-attention with the parameters of torch.nn.MultiheadAttention."""

    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.heads, self.width = heads, width
        self.scale = (width // heads) ** -0.5
        self.in_proj_weight = nn.Parameter(torch.empty(3 * width, width).normal_(0, width**-0.5))
        self.in_proj_bias = nn.Parameter(torch.zeros(3 * width))
        self.out_proj = nn.Linear(width, width)

    def forward(self, tokens: Tensor, bias: Tensor | None) -> Tensor:
        """tokens (n, length, width); bias (n, 1, 1, length): added to the scores, large and negative hides a token."""
        n, length = tokens.shape[:2]
        joint = functional.linear(tokens, self.in_proj_weight, self.in_proj_bias)
        parts = [part.reshape(n, length, self.heads, -1).transpose(1, 2) for part in joint.split(self.width, -1)]
        scores = parts[0] @ parts[1].transpose(2, 3) * self.scale
        shares = torch.softmax(scores if bias is None else scores + bias, -1)
        out: Tensor = self.out_proj((shares @ parts[2]).transpose(1, 2).reshape(n, length, self.width))
        return out


class Layer(nn.Module):
    """A layer of a transformer with normalisation first and GELU, named as torch.nn.TransformerEncoderLayer."""

    def __init__(self, width: int, heads: int = 4, factor: int = 4) -> None:
        super().__init__()
        self.self_attn = Attention(width, heads)
        self.linear1 = nn.Linear(width, factor * width)
        self.linear2 = nn.Linear(factor * width, width)
        self.norm1 = nn.LayerNorm(width)
        self.norm2 = nn.LayerNorm(width)

    def forward(self, tokens: Tensor, bias: Tensor | None = None) -> Tensor:
        """The tokens after the layer, of the same shape."""
        tokens = tokens + self.self_attn(self.norm1(tokens), bias)
        return tokens + self.linear2(functional.gelu(self.linear1(self.norm2(tokens))))


class Layers(nn.Module):
    """Layers in a row."""

    def __init__(self, width: int, count: int) -> None:
        super().__init__()
        self.layers = nn.ModuleList(Layer(width) for _ in range(count))

    def forward(self, tokens: Tensor, bias: Tensor | None = None) -> Tensor:
        """The tokens after all layers, of the same shape."""
        for layer in self.layers:
            tokens = layer(tokens, bias)
        return tokens


class Decoder(nn.Module):
    """ViNT's decoder: 4 layers of a transformer over all tokens, then linear layers down to 32 numbers."""

    def __init__(self, width: int, length: int) -> None:
        super().__init__()
        self.positional_encoding = PositionalEncoding(width, length)
        self.sa_layer = Layer(width)  # never evaluated: a template of training, whose numbers the checkpoints contain
        self.sa_decoder = Layers(width, 4)
        sizes = [length * width, width, 256, 128, 64, 32]
        self.output_layers = nn.ModuleList(nn.Linear(a, b) for a, b in zip(sizes, sizes[1:], strict=False))

    def forward(self, tokens: Tensor) -> Tensor:
        """(n, 32) from (n, length, width)."""
        out = self.sa_decoder(self.positional_encoding(tokens)).flatten(1)
        for layer in self.output_layers:
            out = functional.relu(layer(out))
        return out


class Encoders(nn.Module):
    """Base of ViNT and NoMaD: one token for each image, and one for the present image with the goal."""

    def __init__(self, context_size: int, width: int, norm: Callable[[int], Norm]) -> None:
        super().__init__()
        self.context_size = context_size
        self.obs_encoder = EfficientNet(3, norm)
        self.goal_encoder = EfficientNet(6, norm)
        self.compress_obs_enc = nn.Linear(1280, width)
        self.compress_goal_enc = nn.Linear(1280, width)

    def tokens(self, obs_img: Tensor, goal_img: Tensor) -> Tensor:
        """(1, context_size + 2, width), the oldest image first and the goal last."""
        images = obs_img.reshape(self.context_size + 1, 3, *obs_img.shape[2:])
        seen = self.compress_obs_enc(self.obs_encoder(images))[None]
        both = torch.cat([obs_img[:, 3 * self.context_size :], goal_img], 1)
        return torch.cat([seen, self.compress_goal_enc(self.goal_encoder(both))[:, None]], 1)


class Vint(Encoders):
    """ViNT (arXiv:2306.14846) with early fusion of the goal, as published (vint.yaml)."""

    def __init__(self, context_size: int = 5, count: int = 5) -> None:
        super().__init__(context_size, 512, batch_norm)
        self.count = count
        self.decoder = Decoder(512, context_size + 2)
        self.dist_predictor = nn.Sequential(nn.Linear(32, 1))
        self.action_predictor = nn.Sequential(nn.Linear(32, 4 * count))

    def forward(self, obs_img: Tensor, goal_img: Tensor) -> tuple[Tensor, Tensor]:
        """(1, 1) distance and (1, count, 4) waypoints."""
        joint = self.decoder(self.tokens(obs_img, goal_img))
        return self.dist_predictor(joint), waypoints_of(self.action_predictor(joint), self.count)


class NomadEncoder(Encoders):
    """NoMaD's encoder of images and goal, whose goal can be masked."""

    def __init__(self, context_size: int = 3, width: int = 256) -> None:
        super().__init__(context_size, width, group_norm)
        self.positional_encoding = PositionalEncoding(width, context_size + 2)
        self.sa_layer = Layer(width)  # as in Decoder
        self.sa_encoder = Layers(width, 4)

    def forward(self, obs_img: Tensor, goal_img: Tensor, goal_mask: Tensor) -> Tensor:
        """(1, width): the mean of the tokens, without the goal's where goal_mask (1,) int64 is 1."""
        tokens = self.positional_encoding(self.tokens(obs_img, goal_img))
        is_goal = torch.zeros(self.context_size + 2, device=tokens.device)
        is_goal[-1] = 1.0
        hidden = goal_mask.to(torch.float32)[:, None] * is_goal
        out = self.sa_encoder(tokens, hidden[:, None, None, :] * -1e9)
        share = (1 - hidden)[:, :, None]
        return (out * share).sum(1) / share.sum(1)


class NomadDistance(nn.Module):
    """NoMaD's estimate of the distance to the goal."""

    def __init__(self, width: int = 256) -> None:
        super().__init__()
        sizes = (width, width // 4, width // 16)
        self.network = nn.Sequential(
            nn.Linear(sizes[0], sizes[1]), nn.ReLU(), nn.Linear(sizes[1], sizes[2]), nn.ReLU(), nn.Linear(sizes[2], 1)
        )

    def forward(self, embedding: Tensor) -> Tensor:
        """(n, 1) from (n, width)."""
        out: Tensor = self.network(embedding)
        return out


class Nomad(nn.Module):
    """The three networks of NoMaD (arXiv:2310.07896, nomad.yaml) under the names of its checkpoint."""

    def __init__(self, context_size: int = 3, width: int = 256) -> None:
        super().__init__()
        self.vision_encoder = NomadEncoder(context_size, width)
        self.noise_pred_net = ConditionalUnet(2, width, (64, 128, 256))
        self.dist_pred_net = NomadDistance(width)
