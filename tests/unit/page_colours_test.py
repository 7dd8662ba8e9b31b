"""The colours of core/pages/page.css: text is readable in each scheme, curves are apart for every eye.

page_colours_test.py
"""
import itertools
import pathlib
import re
import unittest

CSS = (pathlib.Path(__file__).parents[2] / "core/pages/page.css").read_text(encoding="utf-8")
TEXT_CONTRAST = 4.5  # WCAG 2.1, 1.4.3
SHAPE_CONTRAST = 3.0  # 1.4.11: strokes
TEXTS = ("ink", "soft", "blue", "done")
GROUNDS = ("paper", "panel", "outer")
BADGES = ("pass", "fail", "open", "void", "none")
CURVES = ("blue", "orange", "green", "violet")
# For linear RGB, severity 1: G. M. Machado, M. M. Oliveira and L. A. F. Fernandes, IEEE Trans. Vis. Comput. Graph. 15 (2009) 1291.
EYES = {
    "normal": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "protan": ((0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)),
    "deutan": ((0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881)),
    "tritan": ((1.255528, -0.076749, -0.178779), (-0.078411, 0.930809, 0.147602), (0.004733, 0.691367, 0.303900)),
}
APART = 15.0  # of CIE 1976 lightness and chroma; 2.3 is just seen side by side


def variables(block):
    return dict(re.findall(r"--([a-z]+):\s*(#[0-9a-fA-F]{6})", block))


def schemes(css):
    """The variables of each scheme, over those of the first :root."""
    roots = re.findall(r"(@media[^{]*\{\s*)?:root\s*\{([^}]*)\}", css)
    base = variables(roots[0][1])
    found = {"light": base}
    for media, block in roots[1:]:
        found["dark" if "dark" in media else "print"] = base | variables(block)
    return found


def linear(colour):
    values = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    return [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in values]


def contrast(a, b):
    shine = sorted(0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in (linear(a), linear(b)))
    return (shine[1] + 0.05) / (shine[0] + 0.05)


def lab(rgb):
    rows = ((0.4124564, 0.3575761, 0.1804375), (0.2126729, 0.7151522, 0.0721750), (0.0193339, 0.1191920, 0.9503041))
    xyz = [sum(k * v for k, v in zip(row, rgb)) / white for row, white in zip(rows, (0.95047, 1.0, 1.08883))]
    f = [v ** (1 / 3) if v > 216 / 24389 else (24389 / 27 * v + 16) / 116 for v in xyz]
    return 116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])


def distance(a, b, eye):
    seen = [lab([min(1, max(0, sum(k * v for k, v in zip(row, linear(colour))))) for row in EYES[eye]]) for colour in (a, b)]
    return sum((x - y) ** 2 for x, y in zip(*seen)) ** 0.5


class PageColours(unittest.TestCase):
    def test_the_formulas_give_what_is_known(self):
        self.assertAlmostEqual(contrast("#000000", "#ffffff"), 21.0)
        self.assertAlmostEqual(contrast("#777777", "#ffffff"), 4.48, places=2)
        self.assertLess(distance("#00a000", "#c07000", "deutan"), 0.5 * distance("#00a000", "#c07000", "normal"))

    def test_every_scheme_is_found(self):
        self.assertEqual(set(schemes(CSS)), {"light", "dark", "print"})

    def test_text_is_readable_on_what_it_stands_on(self):
        for scheme, colours in schemes(CSS).items():
            for text, ground in itertools.product(TEXTS, GROUNDS):
                with self.subTest(scheme=scheme, text=text, ground=ground):
                    self.assertGreaterEqual(contrast(colours[text], colours[ground]), TEXT_CONTRAST)

    def test_badges_are_readable(self):
        self.assertRegex(CSS, r"\.badge \{[^}]*color:\s*#fff;")
        named = re.findall(r"\.badge\.[^{]*\{ background: var\(--([a-z]+)\)", CSS)
        self.assertEqual(set(named), set(BADGES))
        for scheme, colours in schemes(CSS).items():
            for badge in BADGES:
                with self.subTest(scheme=scheme, badge=badge):
                    self.assertGreaterEqual(contrast("#ffffff", colours[badge]), TEXT_CONTRAST)

    def test_curves_are_seen_and_apart_for_every_eye(self):
        for scheme, colours in schemes(CSS).items():
            for curve in CURVES + ("limit",):
                with self.subTest(scheme=scheme, curve=curve):
                    self.assertGreaterEqual(contrast(colours[curve], colours["paper"]), SHAPE_CONTRAST)
            for (a, b), eye in itertools.product(itertools.combinations(CURVES, 2), EYES):
                with self.subTest(scheme=scheme, pair=(a, b), eye=eye):
                    self.assertGreaterEqual(distance(colours[a], colours[b], eye), APART)

    def test_lines_of_a_requirement_differ_in_colour_and_dashes(self):
        drawn = {name: re.search(rf"svg \.{name} \{{([^}}]*)\}}", CSS).group(1) for name in ("limit", "allowed", "bound")}
        for part in (r"stroke: var\(--([a-z]+)\)", r"stroke-dasharray:\s*([\d. ]+)"):
            self.assertEqual(len({re.search(part, style).group(1).strip() for style in drawn.values()}), len(drawn))


if __name__ == "__main__":
    unittest.main()
