"""Reads the EXR files of exact outputs: scan lines of 32-bit floats, ZIP. https://openexr.com/en/latest/OpenEXRFileLayout.html"""
import array
import struct
import zlib

MAGIC = 20000630
FLOAT = 2
ZIP, ZIP_LINES = 3, 16


def read(path):
    """Planes by channel name, rows from the top."""
    data = path.read_bytes()
    if struct.unpack_from("<I", data)[0] != MAGIC:
        raise ValueError(f"{path} is no EXR")
    header, at = {}, 8
    while data[at]:
        name, at = text_at(data, at)
        _, at = text_at(data, at)
        size, = struct.unpack_from("<i", data, at)
        header[name], at = data[at + 4:at + 4 + size], at + 4 + size
    at += 1
    names = channels(header["channels"])
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    if header["compression"][0] != ZIP:
        raise ValueError(f"{path} is not compressed by ZIP")
    width, height = right - left + 1, bottom - top + 1
    planes = {name: array.array("f") for name in names}
    for offset in struct.unpack_from(f"<{-(-height // ZIP_LINES)}Q", data, at):
        line, size = struct.unpack_from("<ii", data, offset)
        lines = min(ZIP_LINES, bottom - line + 1)
        raw_size = 4 * width * lines * len(names)
        block = data[offset + 8:offset + 8 + size]
        values = array.array("f", block if size == raw_size else unzipped(block))
        for row in range(lines):
            for c, name in enumerate(names):
                start = (row * len(names) + c) * width
                planes[name] += values[start:start + width]
    return planes


def text_at(data, at):
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def channels(table):
    names, at = [], 0
    while table[at]:
        name, at = text_at(table, at)
        kind, = struct.unpack_from("<i", table, at)
        if kind != FLOAT:
            raise ValueError(f"channel {name} is not of 32-bit floats")
        names.append(name)
        at += 16
    return names


def unzipped(block):
    """Reverses the predictor (differences of neighbours, split into halves) that EXR applies before compression."""
    data = bytearray(zlib.decompress(block))
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    half = (len(data) + 1) // 2
    out = bytearray(len(data))
    out[0::2], out[1::2] = data[:half], data[half:]
    return bytes(out)
