"""Plots in the style of the report, with Matplotlib, which only this module needs.

Each function draws into `ax` or makes a figure of its own, and returns the axes. `matplotlib.pyplot.show()` or
`ax.figure.savefig(file)` does the rest.
"""
import contextlib
import math
import re

import matplotlib
import matplotlib.pyplot as pyplot
import numpy

from . import _core
from ._arguments import did_you_mean
from .errors import BadInput
from ._flight import Flight, Flights, History
from ._results import Results

# Of the report's style sheet.
INK, SOFT, RULE, PANEL = "#1a2230", "#5b6675", "#d8dee6", "#f5f7fa"
LINES = ("#1f5fa8", "#c8621b", "#2d7d46", "#7350a8")
LIMIT, OUTER, INNER = "#c0272d", "#cfe0f3", "#92b9e3"

STYLE = {
    "figure.dpi": 110, "figure.constrained_layout.use": True, "figure.facecolor": "white",
    "font.family": "sans-serif", "font.size": 10, "text.color": INK,
    "axes.prop_cycle": matplotlib.cycler(color=LINES), "axes.edgecolor": SOFT, "axes.linewidth": 0.8,
    "axes.labelcolor": INK, "axes.labelweight": "semibold", "axes.titlesize": 10.5, "axes.titleweight": "semibold",
    "axes.titlelocation": "left", "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
    "axes.axisbelow": True, "axes.formatter.useoffset": False, "grid.color": RULE, "grid.linewidth": 0.6,
    "xtick.color": SOFT, "ytick.color": SOFT, "lines.linewidth": 1.5, "legend.frameon": False, "legend.fontsize": 9,
}
TIME = "time since lift-off, s"
COAST_S = 10.0  # a gap between burns that is shown as one


@contextlib.contextmanager
def style():
    """The report's style for figures of your own: `with dispersa.plot.style(): ...`."""
    pyplot.draw_if_interactive()  # loads the backend: what a notebook's one sets then must outlive the context
    with matplotlib.rc_context(STYLE):
        yield


def label(name):
    """The title of an axis of a metric, an input or a history column: "Pitch error, peak, °"."""
    name = name.removeprefix("metric_").removeprefix("input_")
    title, unit, definition, _ = _core.describe(name)
    if not definition:
        stem, unit = _core.split_unit(name)
        title = re.sub(r"(?<=stage)(?=\d)", " ", stem).replace("_", " ")
    return f"{title}, {unit}" if unit else title


def history(flights, columns, *, labels=None, axes=None):
    """Columns of the time history of one flight, or of several: a panel for each column.

    `flights`: a Flight or History, or a list of them; `labels`: of the list's. Returns the axes, an array of shape
    (len(columns),). Raises BadInput for a flight without a history or without a column, for no flights and no columns, and
    for labels or axes that are not as many.
    """
    columns = [columns] if isinstance(columns, str) else list(columns)
    histories = _histories_of(flights, ["time_s", *columns], labels)
    if not columns or axes is not None and numpy.size(axes) != len(columns):
        raise BadInput(f"plot: {len(columns)} columns, {len(columns) if axes is None else numpy.size(axes)} axes")
    with style():
        if axes is None:
            _, axes = pyplot.subplots(len(columns), 1, sharex=True, squeeze=False, figsize=(7.2, 0.6 + 2.0 * len(columns)))
        axes = numpy.ravel(axes)
        for ax, column in zip(axes, columns):
            for i, each in enumerate(histories):
                ax.plot(each["time_s"], each[column], label=labels[i] if labels else None,
                        **({} if len(histories) <= len(LINES) else {"color": LINES[0], "linewidth": 0.6, "alpha": 0.5}))
            ax.set_ylabel(_wrapped(label(column)))
            ax.margins(x=0)
            _mark_burns(ax, histories[0])
        axes[-1].set_xlabel(TIME)
        if labels:
            _legend(axes[0])
        axes[0].figure.align_ylabels(axes)
    return axes


def bands(what, column, *, nominal=True, ax=None):
    """The spread of a history column over the cases: least to largest, 1 to 99 % and median of the flights still flying.

    `what`: Results, whose report has made the bands, or Flights with histories of `time_s` and the column. `nominal`:
    of Results, with the nominal flight. Raises BadInput for a column that there are no bands or histories of.
    """
    if isinstance(what, Flights):
        _histories_of(what, ["time_s", column])
    elif not isinstance(what, Results):
        raise BadInput(f"bands: of Results or Flights, not of a {type(what).__name__}")
    with style():
        ax = _axes(ax)
        if isinstance(what, Results):
            table = what.bands()
            if f"{column}_p50" not in table:
                known = [name.removesuffix("_p50") for name in table.columns if name.endswith("_p50")]
                raise BadInput([("", 0, 0, "", f"bands: the report has none of '{column}'", ", ".join(known))])
            times = table["time_s"]
            least, low, median, high, largest = (table[f"{column}_{part}"] for part in ("min", "p01", "p50", "p99", "max"))
        else:
            end_s = max(float(what.history(i)["time_s"][-1]) for i in range(len(what)))
            times = numpy.arange(0.0, max(end_s, 0.2), 0.2)
            values = what.sample(column, times)
            least, low, median, high, largest = numpy.nanpercentile(values, [0, 1, 50, 99, 100], axis=0)
        ax.fill_between(times, least, largest, facecolor=OUTER, edgecolor=INNER, linewidth=0.5, label="min–max")
        ax.fill_between(times, low, high, facecolor=INNER, linewidth=0, label="1–99 %")
        ax.plot(times, median, label="median")
        if isinstance(what, Results):
            flown = what.history()
            if nominal:
                ax.plot(flown["time_s"], flown[column], linewidth=1.2, label="nominal")
            _mark_burns(ax, flown)
        ax.set(xlabel=TIME, ylabel=label(column))
        ax.margins(x=0)
        _legend(ax)
    return ax


def exceedance(results, metric, *, ax=None):
    """The share of completed flights in which a metric exceeds a value, with Clopper's and Pearson's limits of 95 % at
    each value, and the requirements' limits. Raises BadInput for a metric that no completed flight defines."""
    values = numpy.sort(_completed(results, metric))
    n = values.size
    if n == 0:
        raise BadInput(f"exceedance: no completed flight defines '{metric}'")
    beyond = n - numpy.arange(1, n + 1)  # flights above each value
    limits = numpy.array([_core.clopper_pearson(int(k), n, 0.95) for k in beyond])
    with style():
        ax = _axes(ax)
        ax.fill_between(values, limits[:, 0], limits[:, 1], step="post", facecolor=OUTER, edgecolor=INNER, linewidth=0.5,
                        label="95 % limits")
        ax.step(values, beyond / n, where="post", label=f"{n} flights")
        for requirement in results.requirements:
            if requirement["metric"] == metric and requirement.get("limit") is not None:
                ax.axvline(requirement["limit"], color=LIMIT, linestyle=(0, (5, 3)), linewidth=1.2,
                           label="limit, in every case" if requirement["every_case"]
                           else f"limit, for {100 * requirement['probability']:g} %")
        ax.set_yscale("log")
        ax.set_ylim(0.5 / n, 1.2)
        ax.yaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda y, _: f"{100 * y:g} %"))
        ax.set(xlabel=label(metric), ylabel="flights that exceed it")
        _legend(ax)
    return ax


def drivers(results, metric, *, count=3, axes=None):
    """A metric of the completed flights against the inputs that drive it most, each with the share of the variance that
    it explains by itself. Returns the axes, an array of shape (at most `count`,). Raises BadInput for a metric of which the
    report names no drivers."""
    found = [driver for driver in results.summary["drivers"].get(metric, [])]
    if not found:
        raise BadInput([("", 0, 0, "", f"drivers: the report names none of '{metric}'",
                         ", ".join(name for name, list_ in results.summary["drivers"].items() if list_))])
    found = found[:count]
    completed = numpy.array([outcome == "completed" for outcome in results.outcome])
    with style():
        if axes is None:
            _, axes = pyplot.subplots(1, len(found), sharey=True, squeeze=False, figsize=(0.8 + 2.9 * len(found), 3.0))
        axes = numpy.ravel(axes)
        for ax, driver in zip(axes, found):
            values, says = _driver_axis(results.inputs, driver)
            ax.plot(values[completed], results.metrics[metric][completed], ".", markersize=4, alpha=0.6)
            ax.set_xlabel(_wrapped(says, 30))
            ax.set_title(f"{100 * driver['index']:.0f} % of the variance", fontweight="normal", color=SOFT)
        axes[0].set_ylabel(_wrapped(label(metric), 30))
    return axes


def ground_track(flights, *, labels=None, ax=None):
    """The ground track of flights, from lift-off to the end of each: longitude and latitude, to scale at the middle
    of the picture. `flights`: a Flight or History, Flights, or a list. Raises BadInput for a flight without a history of
    both, for no flights, and for labels that are not as many."""
    histories = _histories_of(flights, ["longitude_deg", "latitude_deg"], labels)
    with style():
        ax = pyplot.subplots(figsize=(5.6, 5.2))[1] if ax is None else ax
        many = len(histories) > len(LINES)
        for i, each in enumerate(histories):
            longitude = numpy.degrees(numpy.unwrap(numpy.radians(each["longitude_deg"])))
            line, = ax.plot(longitude, each["latitude_deg"], label=labels[i] if labels else None,
                            **({"color": LINES[0], "linewidth": 0.6, "alpha": 0.5} if many else {}))
            ax.plot(longitude[-1], each["latitude_deg"][-1], "o", markersize=3 if many else 5, color=line.get_color(),
                    label="end" if i == 0 else None)
        first = histories[0]
        ax.plot(first["longitude_deg"][0], first["latitude_deg"][0], "^", color=INK, markersize=7, label="lift-off")
        low, high = ax.get_ylim()
        # A track along a meridian or a parallel is still a picture.
        if high - low < 2.0:
            ax.set_ylim(0.5 * (low + high) - 1.0, 0.5 * (low + high) + 1.0)
        ax.set_aspect(1.0 / math.cos(math.radians(0.5 * (low + high))), adjustable="datalim")
        ax.set(xlabel="longitude, °", ylabel="latitude, °")
        _legend(ax)
    return ax


def _axes(ax):
    return pyplot.subplots(figsize=(7.2, 3.6))[1] if ax is None else ax


def _legend(ax):
    """Above the picture, where it hides nothing; the burns' names stand between."""
    ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.05), borderaxespad=0.0, ncol=5, handlelength=1.6, columnspacing=1.4)


def _histories_of(flights, columns, labels=None):
    """Those of a flight or of several, each with these columns. Raises BadInput."""
    several = list(flights) if isinstance(flights, (list, tuple, Flights)) else [flights]
    histories = [each.history if isinstance(each, Flight) else each for each in several]
    if not histories:
        raise BadInput("plot: there are no flights")
    if labels and len(labels) != len(histories):
        raise BadInput(f"labels: {len(labels)} for {len(histories)} flights")
    for each in histories:
        if not isinstance(each, History):
            raise BadInput("plot: a flight without a history")
        for column in columns:
            if column not in each:
                raise BadInput([("", 0, 0, "", f"plot: the history has no column {column!r}", ", ".join(each.columns))])
    return histories


def _completed(results, metric):
    """Finite values of a metric over the completed flights."""
    if metric not in results.metrics.dtype.names:
        raise BadInput(f"'{metric}' is not a metric of this vehicle{did_you_mean(metric, results.metrics.dtype.names)}")
    values = results.metrics[metric][numpy.array([outcome == "completed" for outcome in results.outcome], dtype=bool)]
    return values[numpy.isfinite(values)]


def _driver_axis(inputs, driver):
    """Values and label of a driver: an input, or a magnitude's component along its direction."""
    name, _, direction = driver["input"].partition(" along ")
    if not direction:
        return inputs[name], label(name)
    part = driver["feature"].split()[1]  # of "m cos x" or "m sin x"
    turn = {"cos": numpy.cos, "sin": numpy.sin}[part](numpy.radians(inputs[direction]))
    title, _, unit = label(name).rpartition(", ")
    return inputs[name] * turn, f"{title} × {part} of {label(direction).rpartition(', ')[0]}, {unit}"


def _wrapped(text, width=24):
    """A label in lines of about `width` letters, broken at spaces."""
    lines = [""]
    for word in text.split(" "):
        if lines[-1] and len(lines[-1]) + 1 + len(word) > width:
            lines.append(word)
        else:
            lines[-1] = f"{lines[-1]} {word}".strip()
    return "\n".join(lines)


def _mark_burns(ax, flown):
    """Ignitions, and coasts as shades, where the history has thrust and stage."""
    if not {"time_s", "stage", "thrust_n"} <= set(flown.columns):
        return
    times, stages, thrust = flown["time_s"], flown["stage"], flown["thrust_n"]
    burns = []  # stage, from, to
    for time, stage in zip(times[thrust > 0.0], stages[thrust > 0.0]):
        if not burns or burns[-1][0] != stage:
            burns.append([stage, time, time])
        burns[-1][2] = time
    for i, (stage, begin, _) in enumerate(burns):
        if i and begin - burns[i - 1][2] > COAST_S:
            ax.axvspan(burns[i - 1][2], begin, facecolor=PANEL, zorder=0)
            _mark(ax, burns[i - 1][2], "coast")
        ax.axvline(begin, color=SOFT, linewidth=0.7, linestyle=(0, (2, 3)), zorder=1)
        _mark(ax, begin, f"S{stage:.0f}")


def _mark(ax, time_s, text):
    ax.annotate(text, (time_s, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 1), textcoords="offset points",
                va="bottom", fontsize=8, color=SOFT)
