"""Lines over time, with axes and units."""
import math

# Five wide; seven rows above the base line, then up to two below it.
GLYPHS = dict(zip("0123456789.-[]/_", """
.###./#...#/#..##/#.#.#/##..#/#...#/.###.
..#../.##../..#../..#../..#../..#../.###.
.###./#...#/....#/...#./..#../.#.../#####
.###./#...#/....#/..##./....#/#...#/.###.
...#./..##./.#.#./#..#./#####/...#./...#.
#####/#..../####./....#/....#/#...#/.###.
..##./.#.../#..../####./#...#/#...#/.###.
#####/....#/...#./..#../..#../.#.../.#...
.###./#...#/#...#/.###./#...#/#...#/.###.
.###./#...#/#...#/.####/....#/...#./.##..
...../...../...../...../...../.##../.##..
...../...../...../.###./...../...../.....
.##../.#.../.#.../.#.../.#.../.#.../.##..
..##./...#./...#./...#./...#./...#./..##.
....#/....#/...#./..#../.#.../#..../#....
...../...../...../...../...../...../...../#####
""".split())) | dict(zip("abcdefghijklmnopqrstuvwxyz", """
...../...../.###./....#/.####/#...#/.####
#..../#..../####./#...#/#...#/#...#/####.
...../...../.###./#..../#..../#..../.###.
....#/....#/.####/#...#/#...#/#...#/.####
...../...../.###./#...#/#####/#..../.###.
..##./.#.../####./.#.../.#.../.#.../.#...
...../...../.####/#...#/#...#/#...#/.####/....#/.###.
#..../#..../#.##./##..#/#...#/#...#/#...#
..#../...../.##../..#../..#../..#../.###.
...#./...../..##./...#./...#./...#./...#./#..#./.##..
#..../#..../#..#./#.#../##.../#.#../#..#.
.##../..#../..#../..#../..#../..#../.###.
...../...../##.#./#.#.#/#.#.#/#.#.#/#.#.#
...../...../#.##./##..#/#...#/#...#/#...#
...../...../.###./#...#/#...#/#...#/.###.
...../...../####./#...#/#...#/#...#/####./#..../#....
...../...../.####/#...#/#...#/#...#/.####/....#/....#
...../...../#.##./##..#/#..../#..../#....
...../...../.####/#..../.###./....#/####.
.#.../.#.../####./.#.../.#.../.#.../..##.
...../...../#...#/#...#/#...#/#..##/.##.#
...../...../#...#/#...#/#...#/.#.#./..#..
...../...../#...#/#.#.#/#.#.#/#.#.#/.#.#.
...../...../#...#/.#.#./..#../.#.#./#...#
...../...../#...#/#...#/#...#/#...#/.####/....#/.###.
...../...../#####/...#./..#../.#.../#####
""".split())) | {" ": ""}
ADVANCE = 6                 # from one character to the next [px]
GROUND, GRID, INK = (24, 24, 30), (62, 62, 74), (225, 225, 225)


class Plot:
    """A line plot with axes that cover `times` [s] and `values`."""
    LEFT, RIGHT, TOP, BOTTOM = 46, 12, 26, 36   # of the axes' frame, from the picture's edges [px]

    def __init__(self, size, times, values, value_label):
        self.size, self.rgb = size, bytearray(bytes(GROUND) * (size[0] * size[1]))
        self.x, self.y = (min(times), max(times)), padded(min(values), max(values))
        x0, x1, y0, y1 = self.LEFT, size[0] - self.RIGHT, size[1] - self.BOTTOM, self.TOP
        for value, words in ticks(*self.x):
            u = self.at(value, self.y[0])[0]
            self.line((u, y0), (u, y1), GRID)
            self.text(words, u - ADVANCE * len(words) // 2, y0 + 6)
        for value, words in ticks(*self.y):
            v = self.at(self.x[0], value)[1]
            self.line((x0, v), (x1, v), GRID)
            self.text(words, x0 - 5 - ADVANCE * len(words), v - 3)
        for a, b in (((x0, y0), (x1, y0)), ((x0, y0), (x0, y1))):
            self.line(a, b, INK)
        self.text("time [s]", (x0 + x1 - ADVANCE * 8) // 2, size[1] - 14)
        self.text(value_label, 6, 8)
        self.legend = x1            # the next entry ends here [px]

    def at(self, time, value):
        across = (time - self.x[0]) / (self.x[1] - self.x[0])
        up = (value - self.y[0]) / (self.y[1] - self.y[0])
        return (round(self.LEFT + across * (self.size[0] - self.LEFT - self.RIGHT)),
                round(self.size[1] - self.BOTTOM - up * (self.size[1] - self.TOP - self.BOTTOM)))

    def series(self, name, times, values, color):
        points = [self.at(*point) for point in zip(times, values)]
        for a, b in zip(points, points[1:]):
            self.line(a, b, color)
        self.legend -= ADVANCE * len(name)
        self.text(name, self.legend, 8, color)
        self.legend -= 2 * ADVANCE

    def line(self, a, b, color):
        n = max(abs(b[0] - a[0]), abs(b[1] - a[1]), 1)
        for i in range(n + 1):
            self.dot(round(a[0] + (b[0] - a[0]) * i / n), round(a[1] + (b[1] - a[1]) * i / n), color)

    def text(self, words, u, v, color=INK):
        for i, c in enumerate(words):
            for y, row in enumerate(GLYPHS[c].split("/")):
                for x, mark in enumerate(row):
                    if mark == "#":
                        self.dot(u + ADVANCE * i + x, v + y, color)

    def dot(self, u, v, color):
        if 0 <= u < self.size[0] and 0 <= v < self.size[1]:
            i = 3 * (v * self.size[0] + u)
            self.rgb[i:i + 3] = bytes(color)


def padded(low, high):
    margin = 0.05 * (high - low) or 1
    return low - margin, high + margin


def ticks(low, high):
    """Four to ten multiples of 1, 2 or 5 times a power of ten, each with its text."""
    power = math.floor(math.log10((high - low) / 4))
    step = max(k * 10 ** power for k in (1, 2, 5) if k * 10 ** power <= (high - low) / 4)
    return [(i * step, f"{i * step:.{max(0, -power)}f}") for i in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]
