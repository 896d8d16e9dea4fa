"""MobileNetV2 and EfficientNet-B0 without their classifiers, with the names of torchvision and efficientnet_pytorch."""

from __future__ import annotations

from collections.abc import Callable

from torch import Tensor, nn
from torch.nn import functional

Norm = nn.BatchNorm2d | nn.GroupNorm

# (expansion, channels, repetitions, stride): Sandler et al. 2018, table 2
_MOBILE = ((1, 16, 1, 1), (6, 24, 2, 2), (6, 32, 3, 2), (6, 64, 4, 2), (6, 96, 3, 1), (6, 160, 3, 2), (6, 320, 1, 1))
# (expansion, channels, repetitions, stride, kernel): Tan and Le 2019, table 1
_EFFICIENT = (
    (1, 16, 1, 1, 3),
    (6, 24, 2, 2, 3),
    (6, 40, 2, 2, 5),
    (6, 80, 3, 2, 3),
    (6, 112, 3, 1, 5),
    (6, 192, 4, 2, 5),
    (6, 320, 1, 1, 3),
)


def _conv_norm(inputs: int, outputs: int, kernel: int = 3, stride: int = 1, groups: int = 1) -> nn.Sequential:
    convolution = nn.Conv2d(inputs, outputs, kernel, stride, (kernel - 1) // 2, groups=groups, bias=False)
    return nn.Sequential(convolution, nn.BatchNorm2d(outputs), nn.ReLU6())


class InvertedResidual(nn.Module):
    """A block of MobileNetV2."""

    def __init__(self, inputs: int, outputs: int, stride: int, expansion: int) -> None:
        super().__init__()
        wide = inputs * expansion
        first = [_conv_norm(inputs, wide, 1)] if expansion != 1 else []
        last = [nn.Conv2d(wide, outputs, 1, bias=False), nn.BatchNorm2d(outputs)]
        self.conv = nn.Sequential(*first, _conv_norm(wide, wide, 3, stride, wide), *last)
        self.adds = stride == 1 and inputs == outputs

    def forward(self, image: Tensor) -> Tensor:
        """Features, of half the size for stride 2."""
        out: Tensor = self.conv(image)
        return image + out if self.adds else out


def mobile_net(channels: int) -> nn.Sequential:
    """MobileNetV2's `features` for images of some channels: (n, 1280, h / 32, w / 32)."""
    blocks: list[nn.Module] = [_conv_norm(channels, 32, 3, 2)]
    inputs = 32
    for expansion, outputs, count, stride in _MOBILE:
        for i in range(count):
            blocks.append(InvertedResidual(inputs, outputs, stride if i == 0 else 1, expansion))
            inputs = outputs
    return nn.Sequential(*blocks, _conv_norm(inputs, 1280, 1))


def batch_norm(channels: int) -> Norm:
    """EfficientNet's normalisation."""
    return nn.BatchNorm2d(channels, eps=1e-3, momentum=0.01)


def group_norm(channels: int) -> Norm:
    """NoMaD's replacement of it: groups of 16 channels, rounded down to a count."""
    return nn.GroupNorm(channels // 16, channels)


class PaddedConv(nn.Conv2d):
    """A convolution with "same" padding as efficientnet_pytorch fixes it for images of 224 x 224, whatever size comes.

    All sizes before a stride of 2 are even then (224, 112, 56, 28, 14), so that kernel - 2 pixels are missing, of which
    the larger half goes to the right and below.
    """

    def __init__(self, inputs: int, outputs: int, kernel: int, stride: int, groups: int = 1) -> None:
        super().__init__(inputs, outputs, kernel, stride, groups=groups, bias=False)
        missing = kernel - stride
        self.before, self.after = missing // 2, missing - missing // 2

    def forward(self, input: Tensor) -> Tensor:
        """Features, of half the size for stride 2."""
        return super().forward(functional.pad(input, (self.before, self.after, self.before, self.after)))


class MbConv(nn.Module):
    """A block of EfficientNet with squeeze and excitation."""

    def __init__(self, inputs: int, row: tuple[int, int, int, int, int], norm: Callable[[int], Norm]) -> None:
        super().__init__()
        expansion, outputs, _, stride, kernel = row
        wide, narrow = inputs * expansion, max(1, inputs // 4)
        self.expands = expansion != 1
        self.adds = stride == 1 and inputs == outputs
        if self.expands:
            self._expand_conv = nn.Conv2d(inputs, wide, 1, bias=False)
            self._bn0 = norm(wide)
        self._depthwise_conv = PaddedConv(wide, wide, kernel, stride, wide)
        self._bn1 = norm(wide)
        self._se_reduce = nn.Conv2d(wide, narrow, 1)
        self._se_expand = nn.Conv2d(narrow, wide, 1)
        self._project_conv = nn.Conv2d(wide, outputs, 1, bias=False)
        self._bn2 = norm(outputs)

    def forward(self, image: Tensor) -> Tensor:
        """Features, of half the size for stride 2."""
        out = functional.silu(self._bn0(self._expand_conv(image))) if self.expands else image
        out = functional.silu(self._bn1(self._depthwise_conv(out)))
        weight = self._se_expand(functional.silu(self._se_reduce(out.mean((2, 3), keepdim=True))))
        out = self._bn2(self._project_conv(weight.sigmoid() * out))
        return image + out if self.adds else out


class EfficientNet(nn.Module):
    """EfficientNet-B0 up to the mean of its features: (n, 1280) from (n, channels, h, w)."""

    def __init__(self, channels: int, norm: Callable[[int], Norm]) -> None:
        super().__init__()
        self._conv_stem = PaddedConv(channels, 32, 3, 2)
        self._bn0 = norm(32)
        self._blocks = nn.ModuleList()
        inputs = 32
        for expansion, outputs, count, stride, kernel in _EFFICIENT:
            for i in range(count):
                row = (expansion, outputs, 1, stride if i == 0 else 1, kernel)
                self._blocks.append(MbConv(inputs, row, norm))
                inputs = outputs
        self._conv_head = nn.Conv2d(inputs, 1280, 1, bias=False)
        self._bn1 = norm(1280)
        self._fc = nn.Linear(1280, 1000)  # never evaluated, but the checkpoints contain it

    def forward(self, image: Tensor) -> Tensor:
        """(n, 1280)."""
        out = functional.silu(self._bn0(self._conv_stem(image)))
        for block in self._blocks:
            out = block(out)
        return functional.silu(self._bn1(self._conv_head(out))).mean((2, 3))
