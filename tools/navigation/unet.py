"""The noise network of NoMaD: a U-Net over time, conditioned on the step of the diffusion and an embedding (Diffusion
Policy, Chi et al. 2023, arXiv:2303.04137; names of real-stanford/diffusion_policy, conditional_unet1d.py)."""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

STEP_WIDTH = 256
GROUPS = 8


class StepEncoding(nn.Module):
    """Sines and cosines of the step."""

    def forward(self, step: Tensor) -> Tensor:
        """(n, 256) from (n,) int64."""
        half = STEP_WIDTH // 2
        rate = torch.exp(torch.arange(half, dtype=torch.float32) * (-math.log(10000.0) / (half - 1)))
        angle = step.to(torch.float32)[:, None] * rate[None]
        return torch.cat([angle.sin(), angle.cos()], -1)


class ConvBlock(nn.Module):
    """Convolution, normalisation by 8 groups, Mish."""

    def __init__(self, inputs: int, outputs: int) -> None:
        super().__init__()
        self.block = nn.Sequential(nn.Conv1d(inputs, outputs, 3, padding=1), nn.GroupNorm(GROUPS, outputs), nn.Mish())

    def forward(self, signal: Tensor) -> Tensor:
        """(n, outputs, time)."""
        out: Tensor = self.block(signal)
        return out


class ResidualBlock(nn.Module):
    """Two convolutions, with a bias per channel from the condition between them."""

    def __init__(self, inputs: int, outputs: int, condition: int) -> None:
        super().__init__()
        self.blocks = nn.ModuleList([ConvBlock(inputs, outputs), ConvBlock(outputs, outputs)])
        self.cond_encoder = nn.Sequential(nn.Mish(), nn.Linear(condition, outputs))
        self.residual_conv = nn.Conv1d(inputs, outputs, 1) if inputs != outputs else nn.Identity()

    def forward(self, signal: Tensor, condition: Tensor) -> Tensor:
        """(n, outputs, time)."""
        out = self.blocks[0](signal) + self.cond_encoder(condition)[:, :, None]
        result: Tensor = self.blocks[1](out) + self.residual_conv(signal)
        return result


class Halve(nn.Module):
    """Half as many samples in time."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.conv = nn.Conv1d(channels, channels, 3, 2, 1)

    def forward(self, signal: Tensor) -> Tensor:
        """(n, channels, time / 2)."""
        out: Tensor = self.conv(signal)
        return out


class Double(nn.Module):
    """Twice as many samples in time."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.conv = nn.ConvTranspose1d(channels, channels, 4, 2, 1)

    def forward(self, signal: Tensor) -> Tensor:
        """(n, channels, 2 time)."""
        out: Tensor = self.conv(signal)
        return out


class ConditionalUnet(nn.Module):
    """(n, time, channels) noise from a sample of that shape; time must be a multiple of 4."""

    def __init__(self, channels: int, condition: int, sizes: tuple[int, ...]) -> None:
        super().__init__()
        width = STEP_WIDTH
        self.diffusion_step_encoder = nn.Sequential(
            StepEncoding(), nn.Linear(width, 4 * width), nn.Mish(), nn.Linear(4 * width, width)
        )
        joint = width + condition
        pairs = list(zip((channels, *sizes), sizes, strict=False))
        self.down_modules = nn.ModuleList()
        for i, (a, b) in enumerate(pairs):
            end = Halve(b) if i < len(pairs) - 1 else nn.Identity()
            self.down_modules.append(nn.ModuleList([ResidualBlock(a, b, joint), ResidualBlock(b, b, joint), end]))
        self.mid_modules = nn.ModuleList(ResidualBlock(sizes[-1], sizes[-1], joint) for _ in range(2))
        self.up_modules = nn.ModuleList()
        for a, b in reversed(pairs[1:]):
            parts = [ResidualBlock(2 * b, a, joint), ResidualBlock(a, a, joint), Double(a)]
            self.up_modules.append(nn.ModuleList(parts))
        self.final_conv = nn.Sequential(ConvBlock(sizes[0], sizes[0]), nn.Conv1d(sizes[0], channels, 1))

    def forward(self, sample: Tensor, timestep: Tensor, embedding: Tensor) -> Tensor:
        """sample (n, time, channels), timestep (1,) int64, embedding (n, condition)."""
        step = self.diffusion_step_encoder(timestep).expand(embedding.shape[0], -1)
        condition = torch.cat([step, embedding], -1)
        signal, kept = sample.transpose(1, 2), []
        for first, second, end in self.down_modules:  # type: ignore[misc]
            signal = second(first(signal, condition), condition)
            kept.append(signal)
            signal = end(signal)
        for block in self.mid_modules:
            signal = block(signal, condition)
        for first, second, end in self.up_modules:  # type: ignore[misc]
            signal = torch.cat([signal, kept.pop()], 1)
            signal = end(second(first(signal, condition), condition))
        out: Tensor = self.final_conv(signal).transpose(1, 2)
        return out
