"""Trains the navigation policy: `python3 -m training.navigation.train DATA --conditions clear --out DIR --seconds 100`.

Requires PyTorch and NumPy. Writes policy.onnx, weights.npz, curves.csv and metrics.json to DIR.
"""

from __future__ import annotations

import argparse
import copy
import csv
import json
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from . import export
from .augment import Augmentation, changed, mirrored
from .dataset import Batch, Data, Sampling, normalised, split
from .measures import Weights, geometry_loss, loss, validate
from .model import Policy, parameters_of


@dataclass(frozen=True)
class Settings:
    """conditions: of the images; seconds: of the training [s]; batch: samples per step; rate: largest learning rate;
    decay: of the weights; ema: of the averaged weights per step; seed: of all random numbers."""

    conditions: tuple[str, ...] = ("clear",)
    seconds: float = 100.0
    batch: int = 1024
    rate: float = 2e-3
    decay: float = 0.05
    ema: float = 0.998
    seed: int = 1
    report_every: float = 5.0


class Trainer:
    """A policy, its average and its optimiser, on the device of the data."""

    def __init__(self, data: Data, settings: Settings) -> None:
        torch.manual_seed(settings.seed)
        torch.backends.cudnn.benchmark = True  # shapes never change
        torch.set_float32_matmul_precision("high")
        self.data, self.settings = data, settings
        self.policy = Policy().to(data.device, memory_format=torch.channels_last)
        self.average = copy.deepcopy(self.policy).eval()
        self.generator = torch.Generator(data.device).manual_seed(settings.seed)
        fused = data.device == "cuda"
        self.optimizer = torch.optim.AdamW(self.policy.parameters(), settings.rate, weight_decay=settings.decay, fused=fused)
        self.steps = 0

    def inputs(self, batch: Batch) -> tuple[Batch, Tensor, Tensor]:
        """A batch mirrored at random, and its changed images."""
        mirror = torch.rand(len(batch.dist), generator=self.generator, device=self.data.device) < 0.5
        batch = mirrored(batch, mirror)
        ranges = Augmentation()
        observation = normalised(changed(batch.observation, self.generator, ranges))
        return batch, observation, normalised(changed(batch.goal, self.generator, ranges))

    def step(self, progress: float) -> Tensor:
        """One step of the optimiser at a share of the training; its loss."""
        for group in self.optimizer.param_groups:
            group["lr"] = self.settings.rate * one_cycle(progress)
        batch, observation, goal = self.inputs(self.data.sample(self.settings.batch, self.generator, Sampling()))
        with torch.autocast(self.data.device, torch.bfloat16, enabled=self.data.device == "cuda"):
            answer = self.policy.answer(observation, goal)
        value = loss(answer.dist, answer.action, batch, Weights()) + geometry_loss(answer, batch, Weights())
        self.optimizer.zero_grad(set_to_none=True)
        value.backward()
        torch.nn.utils.clip_grad_norm_(self.policy.parameters(), 1.0)
        self.optimizer.step()
        self.steps += 1
        keep = min(self.settings.ema, (1 + self.steps) / (10 + self.steps))
        with torch.no_grad():
            pairs = list(zip(self.average.parameters(), self.policy.parameters(), strict=True))
            torch._foreach_lerp_([own for own, _ in pairs], [new for _, new in pairs], 1 - keep)  # noqa: SLF001
        return value.detach()


def one_cycle(progress: float, rise: float = 0.1) -> float:
    """Learning rate relative to its largest (Smith and Topin 2019): a linear rise, then a cosine to zero."""
    if progress < rise:
        return 0.04 + 0.96 * progress / rise
    return float(0.5 + 0.5 * np.cos(np.pi * min((progress - rise) / (1 - rise), 1.0)))


def train(trainer: Trainer, held: Data | None, curves: Path) -> int:
    """Trains for settings.seconds and writes curves.csv: seconds, steps, loss and measures. Returns the steps."""
    settings = trainer.settings
    begin = time.monotonic()
    reported, losses = 0.0, torch.zeros((), device=trainer.data.device)
    count = 0
    rows: list[dict[str, float]] = []
    while (passed := time.monotonic() - begin) < settings.seconds:
        trainer.policy.train()
        losses += trainer.step(passed / settings.seconds)
        count += 1
        if passed - reported < settings.report_every and passed < settings.seconds:
            if trainer.data.device == "cuda" and count % 20 == 0:
                torch.cuda.synchronize()  # or the clock would run ahead of the work
            continue
        reported = passed
        row = {"seconds": round(passed, 1), "steps": float(trainer.steps), "loss": round(float(losses) / count, 5)}
        if held is not None:
            size = min(settings.batch, 512)
            measured = validate(trainer.average, held, 1, size)
            row |= {f"{name}_{key}": value for name, part in measured.items() for key, value in part.items()}
        rows.append(row)
        print(json.dumps(row), flush=True)
        losses.zero_()
        count = 0
    with open(curves, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(dict.fromkeys(sum(map(list, rows), []))), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return trainer.steps


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--conditions", default="clear", help="clear, adversity or both, separated by a comma")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--seconds", type=float, default=Settings.seconds)
    parser.add_argument("--batch", type=int, default=Settings.batch)
    parser.add_argument("--seed", type=int, default=Settings.seed)
    parser.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    options = parser.parse_args(arguments)
    conditions = tuple(options.conditions.split(","))
    settings = Settings(conditions, options.seconds, options.batch, seed=options.seed)
    options.out.mkdir(parents=True, exist_ok=True)
    with np.load(options.data / "routes.npz") as table:
        names = [str(name) for name in table["names"]]
    training, held = split(names)
    data = Data(options.data, conditions, training, options.device)
    known = [name for name in ("clear", "adversity") if (options.data / f"images_{name}.npz").exists()]
    validation = Data(options.data, known, held, options.device)
    trainer = Trainer(data, settings)
    steps = train(trainer, validation, options.out / "curves.csv")
    policy = trainer.average
    measured = validate(policy, validation, 16, min(settings.batch, 512), seed=7)
    report = {
        "settings": asdict(settings),
        "parameters": parameters_of(policy),
        "steps": steps,
        "device": torch.cuda.get_device_name() if options.device == "cuda" else "cpu",
        "places": {"training": [names[n] for n in training], "validation": [names[n] for n in held]},
        "images": {"training": len(data.images), "validation": len(validation.images)},
        "validation": measured,
        "training": validate(policy, data, 8, min(settings.batch, 512), seed=7),
        "onnx": export.write(policy.to("cpu").float(), options.out),
    }
    (options.out / "metrics.json").write_text(json.dumps(report, indent=1) + "\n")
    print(json.dumps(report["validation"]))


if __name__ == "__main__":
    main()
