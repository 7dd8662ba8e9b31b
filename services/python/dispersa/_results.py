"""Result folders: runs, reports, comparisons; margins and references."""
import contextlib
import functools
import gzip
import html
import json
import os
import pathlib
import shutil
import sqlite3

import numpy

from . import _core
from ._arguments import MOST_CASES, MOST_THREADS, did_you_mean, finite, refuse, truth, whole, whole_if_given
from ._shown import html_table, progress_of
from ._source import _in_folder, placed, read, source, text_of
from ._tables import structured
from ._campaign import Campaign, _from_canonical, load, under_law
from .errors import BadInput, ExitCode, Incomplete, InternalError, ReplayMismatch
from ._flight import History

ENVELOPE = 500  # flights that reports fly again for the percentiles over time, unless told otherwise


class Results:
    """A result folder, as it is on the disk when it is opened.

    `directory`: a pathlib.Path. `exit_code`: the verdict as the program's exit code: 0 every requirement met, 3 one
    failed, 4 more cases needed, 5 cases missing. `engine`: the engine version that flew the cases.

    These are arrays of shape (cases,) or lists of that length, in the order of `case_index`: `case_index`, `outcome`,
    `end_time_s` (since lift-off), `end_stage` (from 1), `reason`, `digest`. `inputs`, `metrics`: structured arrays of shape
    (cases,) with a float64 field for each name, in the unit of the name. An undefined metric is NaN. `nominal`: {name: value}
    of every input that the campaign does not set, one for all cases.
    """

    def __init__(self, directory):
        self.directory = pathlib.Path(directory).absolute()
        values = _core.results(os.fspath(self.directory))
        self._stored = json.loads(values["summary"])
        self._summary_text = self._text("summary.json")
        self.exit_code = ExitCode(values["exit_code"])
        self.engine = values["engine"]
        self.case_index = values["case_index"]
        self.outcome = values["outcome"]
        self.end_time_s = values["end_time_s"]
        self.end_stage = values["end_stage"]
        self.reason = values["reason"]
        self.digest = values["digest"]
        self.inputs = structured(values["inputs"], values["input_names"])
        self.nominal = values["nominal"]
        self.metrics = structured(values["metrics"], values["metric_names"])

    def __repr__(self):
        return f"<dispersa.Results {self.directory}: {len(self)} cases, {self.verdict}>"

    def _repr_html_(self):
        """For notebooks: the verdict and the requirements."""
        rows = [(_limits(each), f"{each['failures']} of {each['n']}", each["verdict"]) for each in self.requirements]
        return (f"<p><b>{html.escape(self.campaign.name)}</b>: {len(self)} cases, <b>{html.escape(self.verdict)}</b>, "
                f"<code>{html.escape(str(self.directory))}</code></p>"
                + html_table(("requirement", "failures", "verdict"), rows))

    def __len__(self):
        return len(self.case_index)

    @functools.cached_property
    def campaign(self):
        """The Campaign as flown."""
        return _campaign_in(self.directory)

    @functools.cached_property
    def summary(self):
        """summary.json as a dict: every number of the report. If the run ended before its report, the summary of the stored
        cases. Raises InternalError for a damaged file."""
        if self._summary_text is None:
            return self._stored
        try:
            return json.loads(self._summary_text)
        except ValueError as error:
            raise InternalError(f"{self.directory / 'summary.json'} is damaged: {error}; dispersa.report makes it again") from None

    @property
    def verdict(self):
        """"pass", "fail", "inconclusive", "not_evidence", "study" or "incomplete", for the stored cases."""
        return self._stored["verdict"]

    @property
    def requirements(self):
        """A dict for each requirement, as in summary.json, for the stored cases."""
        return self._stored["requirements"]

    @property
    def report(self):
        """Path of report.html."""
        return self.directory / "report.html"

    def worst(self, metric, count=1):
        """Indices of the worst cases in a metric, a list of at most `count`, the worst first. As in the report, lost flights
        come before all others. These are ordered by their margin to the limits of the campaign's requirements on the metric;
        without any, by the metric's own sense. Raises BadInput for an unknown metric."""
        if metric not in self.metrics.dtype.names:
            raise refuse(f"worst: '{metric}' is not a metric of these flights{did_you_mean(metric, self.metrics.dtype.names)}",
                         "a name of Results.metrics.dtype.names")
        values = self.metrics[metric]
        limits = [each for each in self.requirements if each["metric"] == metric]
        low = max((each["limit"] if each["side"] == "above" else each["low_limit"] for each in limits if each["side"] != "below"),
                  default=None)
        high = min((each["limit"] for each in limits if each["side"] != "above"), default=None)
        worse = _core.describe(metric)[3] if not limits else "larger" if low is None else "smaller" if high is None else "outside"
        if worse == "neither":
            raise refuse(f"worst: no direction of '{metric}' is worse",
                         "a metric that has a worse direction, or a requirement of the campaign")
        badness = {"larger": lambda: values, "smaller": lambda: -values, "farther_from_zero": lambda: numpy.abs(values),
                   "outside": lambda: numpy.maximum(low - values, values - high)}[worse]()
        completed = numpy.array([outcome == "completed" for outcome in self.outcome], dtype=bool)
        badness = numpy.where(completed, badness, numpy.inf)
        order = [i for i in numpy.argsort(-badness, kind="stable") if not numpy.isnan(badness[i])]
        return [int(self.case_index[i]) for i in order[:whole_if_given("count", count, 1)]]

    def probability(self, metric, *, above=None, below=None, confidence_percent=95.0):
        """The probability that a flight's metric is above, or below, a limit in the metric's unit, as a dict. `estimate` is
        `events` / `n`; `low` and `high` are its Clopper-Pearson limits of that two-sided confidence. `n` counts the completed
        flights that define the metric, `left_out` all others. Raises BadInput for an unknown metric, and for points that are
        chosen and not drawn."""
        names = self.metrics.dtype.names
        if metric not in names:
            raise refuse(f"probability: '{metric}' is not a metric of these flights{did_you_mean(metric, names)}",
                         "a name of Results.metrics.dtype.names")
        if (above is None) == (below is None):
            raise refuse("probability: one limit is needed", "above=x or below=x")
        if self._stored["campaign"]["design"] != "monte_carlo":
            raise refuse("probability: the points of a study are chosen, not drawn", "results of method: monte_carlo")
        share = finite("confidence_percent", confidence_percent, 0.1, 99.9999) / 100.0
        completed = numpy.array([outcome == "completed" for outcome in self.outcome], dtype=bool)
        values = self.metrics[metric][completed]
        values = values[numpy.isfinite(values)]
        limit = finite("above" if below is None else "below", above if below is None else below)
        events, n = int(numpy.count_nonzero(values > limit if below is None else values < limit)), len(values)
        low, high = _core.clopper_pearson(events, n, share) if n else (0.0, 1.0)
        return {"events": events, "n": n, "estimate": events / n if n else None, "low": low, "high": high,
                "left_out": len(self) - n}

    def table(self):
        """A structured array of shape (cases,) with the columns of cases.csv."""
        names = ([("case_index", "u8"), ("outcome", "U24"), ("end_time_s", "f8"), ("end_stage", "i4"), ("reason", object)]
                 + [("input_" + name, "f8") for name in self.inputs.dtype.names]
                 + [("metric_" + name, "f8") for name in self.metrics.dtype.names] + [("digest", "U32")])
        table = numpy.empty(len(self), dtype=names)
        for name in ("case_index", "outcome", "end_time_s", "end_stage", "reason", "digest"):
            table[name] = getattr(self, name)
        for prefix, columns in (("input_", self.inputs), ("metric_", self.metrics)):
            for name in columns.dtype.names:
                table[prefix + name] = columns[name]
        return table

    def events(self):
        """What happened in each case, as a structured array of shape (events,): `case_index`, `event`, `time_s` (since
        lift-off), `altitude_m`, `speed_m_s` (over the rotating Earth), `qbar_pa`, `mass_kg`, right after the event. Undefined is
        NaN. By case, then by time. Empty for results of an older release."""
        names = [("case_index", "u8"), ("event", "U40"), ("time_s", "f8"), ("altitude_m", "f8"), ("speed_m_s", "f8"),
                 ("qbar_pa", "f8"), ("mass_kg", "f8")]
        mode = "mode=ro" if os.access(self.directory, os.W_OK) else "immutable=1"
        with contextlib.closing(sqlite3.connect(f"{(self.directory / 'results.sqlite').as_uri()}?{mode}", uri=True)) as database:
            if not database.execute("SELECT 1 FROM sqlite_master WHERE name = 'events'").fetchone():
                return numpy.empty(0, dtype=names)
            rows = database.execute(f"SELECT {', '.join(name for name, _ in names)} FROM events ORDER BY case_index, place")
            return numpy.array([tuple(numpy.nan if value is None else value for value in row) for row in rows], dtype=names)

    @functools.cached_property
    def cases(self):
        """The columns of cases.csv: a pandas.DataFrame, or without pandas the array of table(). The frame's
        attrs["input_keys"] has the campaign file's name of each input: {"input_drag_factor": "drag_coefficient", ...}."""
        try:
            import pandas
        except ImportError:
            return self.table()
        first = {name: getattr(self, name) for name in ("case_index", "outcome", "end_time_s", "end_stage", "reason")}
        parts = [pandas.DataFrame(first)]
        for prefix, columns in (("input_", self.inputs), ("metric_", self.metrics)):
            names = columns.dtype.names
            plain = columns.view(numpy.float64).reshape(len(self), len(names)) if names else numpy.empty((len(self), 0))
            parts.append(pandas.DataFrame(plain, columns=[prefix + name for name in names], copy=False))
        parts.append(pandas.DataFrame({"digest": self.digest}))
        frame = pandas.concat(parts, axis=1)
        frame.attrs["input_keys"] = {"input_" + name: self.campaign.input_keys[name] for name in self.inputs.dtype.names
                                     if self.campaign.input_keys.get(name)}
        return frame

    def bands(self):
        """histories/bands.csv.gz: percentiles over time as a History with columns NAME_min, _p00_27, _p01, _p50,
        _p99, _p99_73 and _max beside time_s. Raises BadInput when the report was made without histories."""
        return self._csv("bands.csv")

    def history(self, case=None):
        """A History that the report wrote: of a case that the report shows, or of the nominal flight if `case` is None. Raises
        BadInput for a case that the report does not show."""
        return self._csv("nominal.csv" if case is None else f"case_{whole('case', case, 0, MOST_CASES)}.csv")

    def _csv(self, name):
        file = self.directory / "histories" / f"{name}.gz"
        if not file.is_file() and file.with_suffix("").is_file():
            file = file.with_suffix("")  # of an older release
        if not file.is_file():
            raise BadInput([(str(file), 0, 0, "", "there is no such history",
                             "Campaign.fly, or report() with histories")])
        with open(file, encoding="utf-8") if file.suffix == ".csv" else gzip.open(file, "rt", encoding="utf-8") as stream:
            columns = stream.readline().strip().split(",")
            return History(numpy.genfromtxt(stream, delimiter=",", ndmin=2), columns)

    def _text(self, name):
        """The text of a file; None if it does not exist."""
        try:
            return (self.directory / name).read_text(encoding="utf-8", errors="replace")
        except FileNotFoundError:
            return None

    def replay(self, case, *, law=None):
        """Flies a stored case again. Returns a dict with its digest. `law`: the control law in Python of the campaign, if it
        has one. Raises ReplayMismatch if one bit differs, and BadInput without that law."""
        answer = json.loads(_core.replay(os.fspath(self.directory), whole("case", case, 0, MOST_CASES), law,
                                         _law_of(self.campaign, law)))
        if not answer["match"]:
            error = ReplayMismatch(f"case {case} is not reproduced: "
                                   + "; ".join(f"{d['name']} stored {d['stored']}, replayed {d['replayed']}"
                                               for d in answer["differences"]))
            error.differences = answer["differences"]
            raise error
        return answer


def _campaign_in(directory):
    file = pathlib.Path(directory) / "campaign.yaml"
    return _from_canonical(str(file), file.read_text(encoding="utf-8"))


def results(directory):
    """Opens a result folder. Raises BadInput if `directory` is not one."""
    return Results(directory)


def worker_program():
    """Path of the program dispersa-worker: of this build or installation, else the one in PATH, else None."""
    package = pathlib.Path(__file__).resolve().parent
    # build/release/python/dispersa, PREFIX/lib/python3/dist-packages/dispersa
    for prefix in (package.parents[1], *package.parents[2:4]):
        program = prefix / "bin" / "dispersa-worker"
        if os.access(program, os.X_OK):
            return str(program)
    return shutil.which("dispersa-worker")


def run(what, out="", *, cases=None, seed=None, autopilot=None, base=None, workers=None, threads=0, resume=False,
        histories=True, envelope=ENVELOPE, progress=None, peer=None, domain=0, address="", keys="", insecure=False,
        priority=0, law=None, axes=None):
    """Flies a campaign and writes its result folder, as `dispersa run` does. Returns its Results.

    `what`: a Campaign, a path, or a dict. `out`: the folder, new or empty unless `resume`; default: results/NAME-ID.
    `workers`: the number of worker processes (default: the usable cores); 0 flies on `threads` threads of this process.
    `histories`: whether the report flies cases again for time histories. `envelope`: the number of these cases.
    `progress(phase, done, total, note)` is called now and then; True shows a bar (tqdm).

    `peer` ("HOST[:PORT]"): the coordinator there flies the campaign, in DDS domain `domain`, and the folder is fetched.
    `keys`: the folder of the client's keys. `insecure`: work without keys. `priority`: -1000 to 1000, as in `dispersa launch`.
    These arguments need `peer`. `workers`, `threads`, `resume`, `histories` and `envelope` are refused with `peer`, because the
    coordinator decides them.

    `law`, `axes` (default: pitch): a control law in Python, as in Campaign.fly. It needs `workers=0`. The campaign has the
    law's name and a hash of everything that decides its commands (its bytecode, closure and references), so the ids depend on
    them. No file stores the law. So these cases can be flown again only with the law, as the report says, and `replay`,
    `report` and `resume` need it as `law` too. The nominal flight and the first cases are flown twice, and `resume` flies a
    stored case again. A law that gives other bits is refused. So is a law that holds an object which the hash cannot cover (a
    generator, an open file).

    The verdict is a value: Results.exit_code. Raises BadInput; Incomplete, with `results`, if cases are missing;
    InternalError, with `results`, if two results of a case differ. Ctrl-C raises KeyboardInterrupt; stored results stay, and
    `resume` continues.
    """
    overrides = {"cases": cases, "seed": seed, "autopilot": autopilot}
    if isinstance(what, Campaign) and all(value is None for value in overrides.values()):
        campaign = what
    else:
        campaign = load(what, base=base, **overrides)
    sha256 = ""
    if law is None and axes is not None:
        raise refuse("axes: need a law in Python", "law=..., or no axes")
    if law is not None:
        if workers != 0 or peer is not None:
            raise refuse("law: a control law in Python flies in this process only",
                         "workers=0 and no peer; for workers and coordinators a plug-in")
        campaign, sha256 = under_law(campaign, law, axes)
        if resume:
            _fly_a_stored_case_again(_folder_of(campaign, out), law)
    if peer is None:
        _refuse_unheeded("with `peer`", domain=(domain, 0), address=(address, ""), keys=(keys, ""),
                         insecure=(insecure, False), priority=(priority, 0))
    else:
        _refuse_unheeded("without `peer`", workers=(workers, None), threads=(threads, 0), resume=(resume, False),
                         histories=(histories, True), envelope=(envelope, ENVELOPE))
    if peer is not None:
        if not hasattr(_core, "run_remotely"):
            raise refuse("peer: this build has no service (DISPERSA_SERVICE=OFF)", "no peer")
        folder = _folder_of(campaign, out)
        code = _core.run_remotely(campaign.name, campaign.canonical_yaml, folder, whole("domain", domain, 0, 99),
                                  os.fspath(peer), os.fspath(address), os.fspath(keys), truth("insecure", insecure),
                                  whole("priority", priority, -1000, 1000), progress_of(progress))
        problem = None
    else:
        program = "" if workers == 0 else worker_program() or "dispersa-worker"
        folder, code, problem = _core.run(campaign.name, campaign.canonical_yaml, os.fspath(out), truth("resume", resume),
                                          -1 if workers is None else whole("workers", workers, 0, MOST_THREADS),
                                          whole("threads", threads, 0, MOST_THREADS), program,
                                          whole("envelope", envelope, 1) if histories else None, progress_of(progress), law,
                                          sha256)
    return _judge(folder, code, problem)


def _refuse_unheeded(where, **arguments):
    """Raises BadInput for one of these, (value, default) each, that is given where it has no meaning."""
    for name, (value, default) in arguments.items():
        if value != default:
            raise refuse(f"{name}: may be given only {where}", "its default")


def _folder_of(campaign, out):
    """The folder of a run's results."""
    return os.fspath(out) or os.path.join("results", f"{campaign.name}-{campaign.id[:8]}")


def _fly_a_stored_case_again(folder, law):
    """Checks that the law gives the stored bits of the folder's first case. The law's hash does not see data that it reads
    from elsewhere. Raises BadInput."""
    if not os.path.exists(os.path.join(folder, "results.sqlite")):
        return
    stored = Results(folder)
    for case in stored.case_index[:1]:
        try:
            stored.replay(case, law=law)
        except ReplayMismatch as error:
            raise refuse(f"law: the folder's first case was flown with another law: {error}",
                         "the law with which the folder was flown") from None


def report(directory, *, histories=True, envelope=ENVELOPE, progress=None, law=None):
    """Writes the reports of a result folder (a path or Results) again, as `dispersa report` does. Returns its Results. The
    arguments are those of run. A campaign with a control law in Python needs that `law` for histories. Raises BadInput."""
    if isinstance(directory, Results):
        directory = directory.directory
    sha256 = "" if law is None else _law_of(_campaign_in(directory), law)
    _core.report(os.fspath(directory), whole("envelope", envelope, 1) if histories else None, progress_of(progress), law, sha256)
    return Results(directory)


def _law_of(campaign, law):
    """The hash of the law with which the campaign was flown. Raises BadInput unless `law` is that one."""
    if law is None:
        return ""
    if campaign.python_law is None:
        raise refuse("law: the campaign was flown with its own autopilot", "no law")
    return under_law(campaign, law)[1]


def _limits(requirement):
    """A requirement of summary.json in words."""
    if requirement["side"] == "within":
        return f"{requirement['metric']} between {requirement['low_limit']:g} and {requirement['limit']:g}"
    return f"{requirement['metric']} {requirement['side']} {requirement['limit']:g}"


def _flat(value, prefix=""):
    """{"a": {"b": 1}} as {"a_b": 1}, an interval as its two ends; other lists are left out."""
    flat = {}
    for key, each in value.items():
        if isinstance(each, dict):
            flat.update(_flat(each, f"{prefix}{key}_"))
        elif not isinstance(each, list):
            flat[prefix + key] = each
        elif len(each) == 2 and not any(isinstance(end, (dict, list)) for end in each):
            flat[f"{prefix}{key}_low"], flat[f"{prefix}{key}_high"] = each
    return flat


class Comparison(dict):
    """compare.json as a dict, with its lists as tables."""

    def table(self, part="metrics"):
        """One row for each item of `part` ("metrics" or "requirements"), one column for each of its values: a pandas.DataFrame,
        or without pandas a list of dicts. Maps are flat: column "median_p" is item["median"]["p"], and "median_interval_low" and
        "median_interval_high" are the ends of an interval. Longer lists are in the dict alone. Raises BadInput for another
        part."""
        if part not in ("metrics", "requirements"):
            raise refuse(f"part: '{part}' is no table", "metrics or requirements")
        rows = [_flat(item) for item in self[part]]
        try:
            import pandas
        except ImportError:
            return rows
        return pandas.DataFrame(rows)

    def _repr_html_(self):
        """For notebooks: what is better or worse in B."""
        rows = [(each["metric"], each["finding"]) for each in self["metrics"] if each["finding"] in ("better", "worse", "differs")]
        return f"<p>{html.escape(self['sentence'])}</p>" + html_table(("metric", "B is"), rows)


def sweep(what, key, values, out, *, base=None, **options):
    """Flies a campaign once for each of several values of one key, or of several keys. Returns {value: Results} in their order.

    `what`: a path or a dict. `key`: path of the key, such as "sampling.seed" or "requirements[0].below"; a path to a campaign
    is read with its files inlined, so that "autopilot.tick_s" or "vehicle.stages[0].motor.thrust_n" work too. With a tuple of
    paths each of `values` is a tuple too, for instance of itertools.product. `out`: a folder, in which each value has its own.
    Other arguments are those of run. Raises BadInput for a key that is not there, and what run raises.
    """
    tree = _read_for(what)
    is_one = isinstance(key, str)
    keys = (key,) if is_one else tuple(key)
    flown = {}
    for value in values:
        own = (value,) if is_one else tuple(value)
        if len(own) != len(keys):
            raise refuse(f"values: {value!r} has {len(own)} values", f"one for each of {len(keys)} keys")
        changed = _in_folder(json.loads(text_of(tree)), base if base is not None else getattr(tree, "folder", "."))
        names = [f"{_set(changed, *pair)}={pair[1]}" for pair in zip(keys, own)]
        flown[value if is_one else own] = run(changed, os.path.join(os.fspath(out), ",".join(names)), **options)
    return flown


def _set(tree, key, value):
    """Sets a key of a campaign, and returns its last name."""
    *parts, last = [int(part) if part.isdigit() else part for part in key.replace("[", ".").replace("]", "").split(".")]
    try:
        for part in parts:
            tree = tree[part]
        tree[last]
    except (KeyError, IndexError, TypeError):
        raise refuse(f"key: the campaign has no '{key}'", "a key that it has, such as sampling.seed") from None
    tree[last] = value
    return last


def _read_for(what):
    return read(what, inlined=True) if isinstance(what, (str, os.PathLike)) else what


def compare(a, b, *, metrics=(), out=""):
    """Compares two result folders (paths or Results), case by case if their draws are the same. Returns a Comparison.

    `metrics`: names without prefix, instead of all. `out`: a folder for compare.html and compare.json. Raises BadInput.
    """
    folders = [os.fspath(each.directory if isinstance(each, Results) else each) for each in (a, b)]
    names = [metrics] if isinstance(metrics, str) else list(metrics)
    for name in names:
        if not isinstance(name, str):
            raise refuse(f"metrics: {name!r} is not a metric", "names of metrics")
    return Comparison(json.loads(_core.compare(*folders, names, os.fspath(out))))


def margins(what, *, cases=None, autopilot=None, base=None, frequency_band_percent=15.0, drift=False):
    """Gain, phase and delay margins of a campaign's autopilot, computed and measured in flight, as the dict that
    `dispersa margins --json` prints. `passed` is whether every gate is met.

    `cases`: number of dispersed cases whose margins are computed too. `frequency_band_percent`: error of the bending
    frequencies. `drift`: linearise with the lateral velocity. Raises BadInput.
    """
    campaign = _loaded(what, autopilot, base)
    return json.loads(_core.margins(campaign.name, campaign.canonical_yaml, whole_if_given("cases", cases, 1, MOST_CASES),
                                    finite("frequency_band_percent", frequency_band_percent, 0.0, 50.0), drift))


def _loaded(what, autopilot=None, base=None):
    return what if isinstance(what, Campaign) and autopilot is None else load(what, autopilot=autopilot, base=base)


def search(what, metric=None, *, below=None, above=None, flights=1000, starts=4, reach_sigma=6.0, seed=None, base=None, progress=None):
    """The smallest dispersion found that fails a requirement, as the dict that `dispersa search --json` prints: `found`,
    `distance` in standard deviations, `dispersions`, `inputs`, and a `sentence` that says what this shows.

    `metric`: of the requirement; default: the campaign's first. `below`, `above`: a limit instead of the campaign's. `flights`:
    20 to 1,000,000. `starts`: 1 to 100. `reach_sigma`: the farthest distance in standard deviations, 0.1 to 8. Raises BadInput.
    """
    campaign = _loaded(what, base=base)
    if metric is None and (below is not None or above is not None):
        raise refuse("metric: below and above need one", "a name of metric_names")
    if below is not None and above is not None:
        raise refuse("below, above: both are given", "one of them")
    if metric is not None and metric not in campaign.metric_names:
        raise refuse(f"metric: {metric!r} is not a metric{did_you_mean(metric, campaign.metric_names)}", "a name of metric_names")
    limits = tuple(None if each is None else finite(name, each) for name, each in (("below", below), ("above", above)))
    return json.loads(_core.search(campaign.name, campaign.canonical_yaml, metric or "", limits,
                                   whole("flights", flights, 20, 1000000), whole("starts", starts, 1, 100),
                                   finite("reach_sigma", reach_sigma, 0.1, 8.0), whole_if_given("seed", seed), progress_of(progress)))


class Tuning(dict):
    """The object that `dispersa tune --json` prints, as a dict. `yaml`: the text of the autopilot file."""

    yaml = ""

    @property
    def exit_code(self):
        """An ExitCode: 0 if a design meets every constraint, 3 if none does: the file has the best one found."""
        return ExitCode.DONE if self["feasible"] else ExitCode.REQUIREMENT_FAILED


def tune(what, out="", *, autopilot="", seed=1, cases=4, evaluations=160, dispersed=0, lqr=False, threads=0, base=None,
         progress=None):
    """Finds the gains of an autopilot with any control law, as `dispersa tune` does. Returns a Tuning.

    `out`: a file for the autopilot. `autopilot`: a file with the law and the fixed parameters, instead of the campaign's.
    `seed`: of the search and of its cases. `cases`: flown for each design. `evaluations`: designs to try. `dispersed`: cases in
    which every design must meet the gates of dispersed flights. `lqr`: search the weights of a linear-quadratic regulator. The
    result does not depend on `threads` (0: the usable cores). Raises BadInput.
    """
    campaign = _loaded(what, base=base)
    printed, yaml = _core.tune(campaign.name, campaign.canonical_yaml, os.fspath(autopilot), os.fspath(out), whole("seed", seed),
                               whole("cases", cases, 1, 10000), whole("evaluations", evaluations, 1, 1000000),
                               whole("dispersed", dispersed, 0, 1000), truth("lqr", lqr), whole("threads", threads, 0, MOST_THREADS),
                               progress_of(progress))
    tuning = Tuning(json.loads(printed))
    tuning.yaml = yaml
    return tuning


class Optimization(dict):
    """The object that `dispersa optimize --json` prints, as a dict. `yaml`: the text of the reference file. `statement`: how
    far the search missed its target, or why its check flight was lost; or empty."""

    yaml = ""
    statement = ""

    @property
    def reached(self):
        """Whether the target is reached, and the check flight completed. A miss is a result too, not an exception."""
        return self["reached"]

    @property
    def exit_code(self):
        """An ExitCode: 0 if it is reached, 3 if it is missed."""
        return ExitCode.DONE if self.reached else ExitCode.REQUIREMENT_FAILED


def optimize(what, out="", *, seed=None, threads=0, base=None, progress=None):
    """Finds the flight program that reaches a campaign's target orbit. Returns an Optimization.

    `what`: a path, a dict or a Campaign, with an optimize block or a reference. `out`: a file for the reference; time
    history and figures go beside it. The result does not depend on `threads` (0: the usable cores). Raises BadInput.
    """
    name, text = source(what, base)
    with placed(name, text):
        printed, yaml, statement = _core.optimize(name, text, whole_if_given("seed", seed), whole("threads", threads, 0, MOST_THREADS),
                                                  os.fspath(out), progress_of(progress))
    optimization = Optimization(json.loads(printed))
    optimization.yaml, optimization.statement = yaml, statement
    return optimization


def _judge(folder, code, problem):
    """The Results of a run, or what stands in the verdict's way."""
    found = Results(folder)
    if code in (ExitCode.INCOMPLETE, ExitCode.INTERNAL_ERROR):
        missing = f"{folder}: cases are missing" + (f": {problem}" if problem else "")
        error = Incomplete(missing) if code == ExitCode.INCOMPLETE else InternalError(
            f"{folder}: a case was returned twice with different bits")
        error.results = found
        raise error
    return found
