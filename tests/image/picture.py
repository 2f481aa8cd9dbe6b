"""Pictures: what the monitor shows against what the program drew."""

import struct
import zlib


class Picture:
    def __init__(self, width, height, rgb):
        self.width, self.height, self.rgb = width, height, rgb

    def pixel(self, x, y):
        at = 3 * (y * self.width + x)
        return self.rgb[at:at + 3]

    def grey_cells(self, cell):
        """Mean brightness of square cells, line by line."""
        rows = []
        for top in range(0, self.height - cell + 1, cell):
            row = []
            for left in range(0, self.width - cell + 1, cell):
                total = 0
                for y in range(top, top + cell):
                    at = 3 * (y * self.width + left)
                    total += sum(self.rgb[at:at + 3 * cell])
                row.append(total / (3 * cell * cell))
            rows.append(row)
        return rows

    def share(self, suits):
        """Of the pixels (every second of every second line) that suit."""
        found = all_of_them = 0
        for y in range(0, self.height, 2):
            for x in range(0, self.width, 2):
                all_of_them += 1
                found += bool(suits(*self.pixel(x, y)))
        return found / max(1, all_of_them)


def read_ppm(path):
    data = open(path, "rb").read()
    fields, at = [], 0
    while len(fields) < 4:
        end = at
        while data[end:end + 1] not in b" \t\n":
            end += 1
        fields.append(data[at:end])
        at = end + 1
    if fields[0] != b"P6" or fields[3] != b"255":
        raise ValueError(f"{path}: {fields}, expected a P6 picture of 8 bits")
    return Picture(int(fields[1]), int(fields[2]), data[at:])


def read_png(path):
    """8 bits RGB or RGBA, not interlaced: what octascope writes."""
    data = open(path, "rb").read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    channels = {2: 3, 6: 4}.get(colour)
    if depth != 8 or interlaced or not channels:
        raise ValueError(f"{path}: a PNG of another kind than octascope writes")
    raw, stride = zlib.decompress(packed), width * channels
    rgb, before = bytearray(), bytearray(stride)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        line = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride if kind else 0):
            left = line[i - channels] if i >= channels else 0
            above = before[i]
            corner = before[i - channels] if i >= channels else 0
            if kind == 1:
                line[i] = (line[i] + left) & 255
            elif kind == 2:
                line[i] = (line[i] + above) & 255
            elif kind == 3:
                line[i] = (line[i] + (left + above) // 2) & 255
            else:
                p = left + above - corner
                near = min((abs(p - left), 0, left), (abs(p - above), 1, above), (abs(p - corner), 2, corner))
                line[i] = (line[i] + near[2]) & 255
        before = line
        if channels == 3:
            rgb += line
        else:
            for i in range(0, stride, 4):
                rgb += line[i:i + 3]
    return Picture(width, height, bytes(rgb))


def similarity(a, b, cell=4, window=8):
    """Structural similarity (Wang et al. 2004) of the brightness of cells: 1 for the same picture. The
    coarse cells forgive the digits of the status line, not another scene."""
    if (a.width, a.height) != (b.width, b.height):
        return 0.0
    x, y = a.grey_cells(cell), b.grey_cells(cell)
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    total = count = 0
    for top in range(0, len(x) - window + 1, window // 2):
        for left in range(0, len(x[0]) - window + 1, window // 2):
            xs = [v for row in x[top:top + window] for v in row[left:left + window]]
            ys = [v for row in y[top:top + window] for v in row[left:left + window]]
            n = len(xs)
            mx, my = sum(xs) / n, sum(ys) / n
            vx = sum((v - mx) ** 2 for v in xs) / (n - 1)
            vy = sum((v - my) ** 2 for v in ys) / (n - 1)
            cov = sum((p - mx) * (q - my) for p, q in zip(xs, ys)) / (n - 1)
            total += (2 * mx * my + c1) * (2 * cov + c2) / ((mx * mx + my * my + c1) * (vx + vy + c2))
            count += 1
    return total / max(1, count)
