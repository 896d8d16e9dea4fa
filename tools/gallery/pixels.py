"""Reads and writes pictures with ffmpeg, and detects faults that are independent of their content."""
import array
import subprocess


def ffmpeg(path, *form):
    return subprocess.run(["ffmpeg", "-v", "error", "-i", path, *form, "-"], stdin=subprocess.DEVNULL, check=True, capture_output=True).stdout


def jpeg(path):
    return ffmpeg(path, "-pix_fmt", "yuv444p", "-q:v", "6", "-flags", "+bitexact", "-f", "mjpeg")


def raw(path, pixels):
    return ffmpeg(path, "-f", "rawvideo", "-pix_fmt", pixels)


def fault_of_light(values):
    bad = sum(not 0 <= value < 1e9 for value in values)
    return f"{bad} values of {len(values)} are negative, infinite or NaN" if bad else None


def fault_of_display(grey):
    """Of the displayed picture's grey values, 0 … 255."""
    mean, count = sum(grey) / len(grey), len(grey)
    if mean < 12:
        return f"black: mean {mean:.0f} of 255"
    if mean > 243 or sum(value >= 254 for value in grey) > 0.5 * count:
        return f"white: mean {mean:.0f} of 255"
    if max(grey) - min(grey) < 20:
        return f"no contrast: values from {min(grey)} to {max(grey)} of 255"
    return None
