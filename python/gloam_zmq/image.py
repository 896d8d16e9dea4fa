"""sensor_msgs/msg/Image in CDR as an array, without a copy."""
import struct

_DTYPES = {"rgb8": ("u1", 3), "bgr8": ("u1", 3), "mono8": ("u1", 1), "mono16": ("<u2", 1), "16UC1": ("<u2", 1), "32FC1": ("<f4", 1),
           "8UC1": ("u1", 1), "8UC3": ("u1", 3), "32FC3": ("<f4", 3), "rgba8": ("u1", 4)}


class _Reader:
    """Little-endian CDR: numbers aligned to their size from the end of the head of four bytes."""

    def __init__(self, data):
        if bytes(data[:2]) != b"\x00\x01":
            raise ValueError("the message is not little-endian CDR")
        self.data, self.at = data, 4

    def number(self, letter, size):
        self.at += -(self.at - 4) % size
        value = struct.unpack_from("<" + letter, self.data, self.at)[0]
        self.at += size
        return value

    def text(self):
        size = self.number("I", 4)
        value = bytes(self.data[self.at:self.at + max(size - 1, 0)]).decode()
        self.at += size
        return value


def image_array(data):
    """(array, encoding) of an Image in CDR. array: (height, width) or (height, width, channels), a view of `data`;
    rgb8 sRGB 0…255, 32FC1 [m], mono16 ids or the topic's own unit."""
    import numpy
    reader = _Reader(data)
    reader.number("i", 4)  # stamp
    reader.number("I", 4)
    reader.text()  # frame
    height, width, encoding = reader.number("I", 4), reader.number("I", 4), reader.text()
    reader.number("B", 1)
    row, size = reader.number("I", 4), reader.number("I", 4)
    if encoding not in _DTYPES:
        raise ValueError(f"images in '{encoding}' cannot be converted to an array")
    dtype, channels = _DTYPES[encoding]
    kind = numpy.dtype(dtype)
    if size < row * height or row != width * channels * kind.itemsize:
        raise ValueError("the image has padded rows or is truncated")
    flat = numpy.frombuffer(data, dtype=kind, count=width * height * channels, offset=reader.at)
    return flat.reshape((height, width) if channels == 1 else (height, width, channels)), encoding
