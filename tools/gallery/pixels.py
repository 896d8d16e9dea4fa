"""What can be told of a picture without knowing what it shows."""
import array
import subprocess


def raw(path, form):
    return subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", form, "-"], check=True, capture_output=True).stdout


def fault(png, exr):
    """Why this cannot be a good picture: not numbers, black, white, or all one colour; None if it can."""
    light = array.array("f", raw(exr, "gbrpf32le"))
    bad = sum(not 0 <= value < 1e9 for value in light)
    if bad:
        return f"{bad} values of {len(light)} are no light: negative, infinite or not numbers"
    return fault_of_display(raw(png, "gray"))


def fault_of_display(grey):
    """The same of the displayed picture's grey values, 0 … 255."""
    mean, count = sum(grey) / len(grey), len(grey)
    if mean < 12:
        return f"black: mean {mean:.0f} of 255"
    if mean > 243 or sum(value >= 254 for value in grey) > 0.5 * count:
        return f"white: mean {mean:.0f} of 255"
    if max(grey) - min(grey) < 20:
        return f"nothing to see: values from {min(grey)} to {max(grey)} of 255"
    return None
