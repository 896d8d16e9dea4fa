"""Publishes a trained policy: `python3 -m training.navigation.publish RESULT [--clear RESULT_OF_CLEAR]`.

Copies policy.onnx and curves.csv to assets/policies/navigation and writes its README.md from card.md and metrics.json.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
_MARK = re.compile(r"\{\{\s*([a-z_.]+)\s*\}\}")
_ROWS = (
    ("distance to the goal, mean absolute error [steps]", "dist_mae", "{:.2f}"),
    ("waypoints, mean distance from their labels [m]", "waypoint_m", "{:.3f}"),
    ("direction of the third waypoint, mean cosine", "direction_cos", "{:.3f}"),
    ("headings, mean cosine", "heading_cos", "{:.3f}"),
    ("answer to goals elsewhere, mean; 20 is right [steps]", "negative_dist", "{:.1f}"),
    ("increase of the waypoints' error with another goal [m]", "goal_gain_m", "{:.3f}"),
)


def filled(template: str, values: Mapping[str, str]) -> str:
    """The template with `{{ name }}` replaced. Errors: KeyError for a name without a value."""
    return _MARK.sub(lambda match: values[match.group(1)], template)


def table(columns: Sequence[tuple[str, Mapping[str, float]]]) -> str:
    """Measures as a Markdown table with a column per validation (title, measures)."""
    lines = ["| | " + " | ".join(title for title, _ in columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for title, key, form in _ROWS:
        lines.append(f"| {title} | " + " | ".join(form.format(part[key]) for _, part in columns) + " |")
    return "\n".join(lines)


def card_values(metrics: Mapping[str, Any], clear: Mapping[str, Any] | None) -> dict[str, str]:
    """Values of the card's marks from metrics.json of the policy, and of a training on clear images only."""
    columns = [(name, part) for name, part in metrics["validation"].items() if name != "all"]
    if clear is not None:
        columns += [(f"{name}, trained on clear only", part) for name, part in clear["validation"].items() if name != "all"]
    settings, places = metrics["settings"], metrics["places"]
    return {
        "parameters": f"{metrics['parameters'] / 1e6:.2f} million",
        "megabytes": f"{metrics['onnx']['bytes'] / 1e6:.1f}",
        "steps": f"{metrics['steps']:,}",
        "seconds": f"{settings['seconds']:g}",
        "batch": f"{settings['batch']:,}",
        "seed": str(settings["seed"]),
        "device": metrics["device"],
        "conditions": " and ".join(settings["conditions"]),
        "training_images": f"{metrics['images']['training']:,}",
        "validation_images": f"{metrics['images']['validation']:,}",
        "training_places": str(len(places["training"])),
        "validation_places": str(len(places["validation"])),
        "difference": f"{metrics['onnx'].get('largest_difference', float('nan')):.1e}",
        "table": table(columns),
    }


def publish(result: Path, clear: Path | None, folder: Path) -> None:
    """Writes the published files. Errors: OSError if one is missing; ValueError if the export failed."""
    metrics = json.loads((result / "metrics.json").read_text())
    if not metrics["onnx"]["bytes"]:
        raise ValueError(f"{result} has no network: {metrics['onnx'].get('error')}")
    other = json.loads((clear / "metrics.json").read_text()) if clear else None
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(result / "policy.onnx", folder / "policy.onnx")
    shutil.copyfile(result / "curves.csv", folder / "training.csv")
    template = (Path(__file__).parent / "card.md").read_text()
    (folder / "README.md").write_text(filled(template, card_values(metrics, other)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("result", type=Path, help="folder that train.py wrote")
    parser.add_argument("--clear", type=Path, help="result of a training on clear images, for comparison")
    parser.add_argument("--folder", type=Path, default=ROOT / "assets/policies/navigation")
    options = parser.parse_args()
    publish(options.result, options.clear, options.folder)


if __name__ == "__main__":
    main()
