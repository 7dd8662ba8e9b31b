#!/usr/bin/env python3
"""Makes core/pages/coast_lines.txt from land-110m.json of the npm package world-atlas 2.0.2.

    npm pack world-atlas@2.0.2 && tar xzf world-atlas-2.0.2.tgz
    tests/tools/coast_lines.py package/land-110m.json > core/pages/coast_lines.txt

The coast lines are those of Natural Earth, 1:110 million (naturalearthdata.com), which are in the public domain.
"""
import hashlib
import json
import math
import pathlib
import sys

SOURCE_SHA256 = "ead5f68119c49a9250902e7da303bcb209341bbb8fefe7369a439b48b704658a"
UNIT_PER_DEG = 10  # 0.1 degree is 11 km: finer than a line of this scale is right
UNSEEN_UNITS = 0.6  # a point this near to the line through its neighbours goes


def arcs_of(topology):
    """The arcs in degrees: longitude, latitude (TopoJSON 1.0, section 2.1.4)."""
    (scale_x, scale_y), (left, bottom) = topology["transform"]["scale"], topology["transform"]["translate"]
    for arc in topology["arcs"]:
        x = y = 0
        points = []
        for dx, dy in arc:
            x, y = x + dx, y + dy
            points.append((x * scale_x + left, y * scale_y + bottom))
        yield points


def is_seam(a, b):
    """No coast: a polygon was closed along the antimeridian or the south pole."""
    return abs(a[0] - b[0]) > 180 or (abs(a[0]) > 179.99 and abs(b[0]) > 179.99) or (a[1] < -85.5 and b[1] < -85.5)


def coasts_of(points):
    line = []
    for i, point in enumerate(points):
        if i > 0 and is_seam(points[i - 1], point):
            yield line
            line = []
        line.append(point)
    yield line


def straightened(line):
    """D. H. Douglas and T. K. Peucker, Cartographica 10 (1973) 112-122."""
    if len(line) < 3:
        return line
    (ax, ay), (bx, by) = line[0], line[-1]
    length = math.hypot(bx - ax, by - ay)

    def distance(point):
        if length == 0:
            return math.hypot(point[0] - ax, point[1] - ay)
        return abs((bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax)) / length

    farthest = max(range(1, len(line) - 1), key=lambda i: distance(line[i]))
    if distance(line[farthest]) <= UNSEEN_UNITS:
        return [line[0], line[-1]]
    return straightened(line[:farthest + 1])[:-1] + straightened(line[farthest:])


def main():
    text = pathlib.Path(sys.argv[1]).read_bytes()
    found = hashlib.sha256(text).hexdigest()
    if found != SOURCE_SHA256:
        sys.exit(f"{sys.argv[1]}: SHA-256 {found}, expected {SOURCE_SHA256}: land-110m.json of world-atlas 2.0.2")
    rows = []
    for arc in arcs_of(json.loads(text)):
        for coast in coasts_of(arc):
            units = [(round(x * UNIT_PER_DEG), round(y * UNIT_PER_DEG)) for x, y in coast]
            units = straightened([p for i, p in enumerate(units) if i == 0 or p != units[i - 1]])
            if len(units) < 2:
                continue
            steps = [units[0]] + [(b[0] - a[0], b[1] - a[1]) for a, b in zip(units, units[1:])]
            rows.append(" ".join(f"{x} {y}" for x, y in steps))
    body = "\n".join(rows) + "\n"
    print("# Coast lines of Natural Earth, 1:110 million (naturalearthdata.com): public domain.")
    print("# From land-110m.json of the npm package world-atlas 2.0.2, by tests/tools/coast_lines.py.")
    print(f"# SHA-256 of that file: {SOURCE_SHA256}")
    print(f"# SHA-256 of the lines below: {hashlib.sha256(body.encode()).hexdigest()}")
    print("# A line: longitude and latitude in 0.1 degree, then the steps to each next point.")
    sys.stdout.write(body)


main()
