"""Campaigns: loaded, planned, flown in this process."""
import collections.abc
import dataclasses
import functools
import html
import os
import warnings

from . import _core
from ._arguments import MOST_CASES, MOST_THREADS, as_whole, finite, refuse, whole, whole_if_given
from ._law import identity
from ._shown import html_table, progress_of
from ._source import placed, source, without_place
from ._tables import structured
from .errors import BadInput, ExitCode, InputWarning, Problem
from ._flight import Flight, Flights, History


@dataclasses.dataclass(frozen=True)
class Validation:
    """The result of `validate`: the problems of a file."""

    errors: list
    """Problems, in the order of the text; empty when the file is valid."""
    warnings: list
    """Problems of a valid file that do not prevent flights, such as unusual values."""
    strict: bool = False
    """Warnings count as errors."""

    @property
    def valid(self):
        """No errors, and if strict no warnings; `bool(validation)` says the same."""
        return not self.errors and not (self.strict and self.warnings)

    @property
    def exit_code(self):
        """An ExitCode: that of `dispersa validate`, 0 or 2."""
        return ExitCode.DONE if self.valid else ExitCode.BAD_INPUT

    def __bool__(self):
        return self.valid


def validate(what, *, base=None, strict=False):
    """Finds every error of a campaign, vehicle, reference, autopilot or scenario, given as a path or a dict.

    `base`: folder to which file names in a dict are relative. `strict`: warnings are errors. Raises nothing for a wrong
    input; the result has the errors.
    """
    try:
        name, text = source(what, base)
    except BadInput as error:  # what has no place in a file
        return Validation(error.problems, [], strict)
    errors, found = _core.check(name, text)
    return Validation(*([without_place(Problem(*p), name, text) for p in each] for each in (errors, found)), strict)


def load(what, *, cases=None, seed=None, autopilot=None, base=None):
    """Loads a campaign from a path or a dict, to be planned, flown and run.

    `cases`, `seed` and `autopilot` (a file) replace the campaign's own. `base`: folder to which file names in a dict are
    relative. Raises BadInput with every problem. Warns (InputWarning) of values that are allowed but look wrong.
    """
    name, text = source(what, base)
    if autopilot is not None and not (autopilot := os.fspath(autopilot)):
        raise refuse("autopilot: '' is no file", "an autopilot file")
    with placed(name, text):
        campaign = Campaign(_core.load(name, text, whole_if_given("cases", cases, 1, MOST_CASES),
                                       whole_if_given("seed", seed), autopilot))
    for problem in campaign.warnings:
        warnings.warn(str(problem), InputWarning, stacklevel=2)
    return campaign


class Campaign:
    """A dispersion campaign, immutable. Two with the same `id` are the same; `load` makes one."""

    def __init__(self, core):
        self._core = core

    def __repr__(self):
        return f"<dispersa.Campaign {self.name} {self.id[:8]}: {self.cases} cases, seed {self.seed}>"

    def _repr_html_(self):
        """For notebooks: what flies, and what varies."""
        inputs = {}
        for name in self.dispersed:
            inputs.setdefault(self.input_keys.get(name, name), []).append(name)
        return (f"<p><b>{html.escape(self.name)}</b> {self.id[:8]}: {self.cases} cases, seed {self.seed}; "
                f"{html.escape(self.vehicle)} under {html.escape(self.autopilot)}</p>"
                + html_table(("dispersion", "inputs"), [(key, ", ".join(names)) for key, names in inputs.items()]))

    def __eq__(self, other):
        return isinstance(other, Campaign) and self.id == other.id

    def __hash__(self):
        return hash(self.id)

    def __reduce__(self):
        return _from_canonical, (self.name, self.canonical_yaml), {"warnings": self.warnings}

    @property
    def name(self):
        """As the file names it."""
        return self._core.name

    @property
    def id(self):
        """SHA-256 of canonical_yaml, hexadecimal."""
        return self._core.id

    @property
    def flight_id(self):
        """SHA-256 of everything that decides a flight."""
        return self._core.flight_id

    @property
    def requirements_id(self):
        """SHA-256 of the requirements and their verdict plans."""
        return self._core.requirements_id

    @property
    def canonical_yaml(self):
        """Everything inlined, keys sorted: the bytes of a result folder's campaign.yaml."""
        return self._core.canonical_yaml

    @property
    def cases(self):
        """The number of cases; indices count from 0."""
        return self._core.cases

    @property
    def seed(self):
        """The seed of the draws."""
        return self._core.seed

    @property
    def stages(self):
        """The number of the vehicle's stages."""
        return self._core.stages

    @property
    def vehicle(self):
        """The vehicle's name."""
        return self._core.vehicle

    @property
    def autopilot(self):
        """The autopilot's name."""
        return self._core.autopilot

    @property
    def python_law(self):
        """(name, SHA-256) of the control law in Python that the campaign was flown with, else None. No file stores the law.
        So such a campaign can be flown only with the same law as `law`."""
        return self._core.python_law

    @functools.cached_property
    def warnings(self):
        """Problems of the file that do not prevent flights."""
        return tuple(Problem(*p) for p in self._core.warnings)

    @functools.cached_property
    def input_names(self):
        """Names of all inputs of the vehicle's flights, with units; cases.csv has those in `dispersed` as input_NAME."""
        return tuple(self._core.input_names)

    @functools.cached_property
    def input_keys(self):
        """The campaign file's name of each input: {"drag_factor": "drag_coefficient", ...}. An empty name: the input cannot
        be dispersed."""
        return dict(zip(self.input_names, self._core.input_keys))

    @functools.cached_property
    def metric_names(self):
        """Names of the metrics of a flight under the campaign's own control law, with units; cases.csv has them as
        metric_NAME."""
        return tuple(self._core.metric_names)

    @functools.cached_property
    def dispersed(self):
        """Names of the inputs that an entry of `dispersions` or `derived` sets: those of cases.csv."""
        return tuple(self._core.dispersed)

    def plan(self, cases=None):
        """Draws the inputs of the cases without flying. Returns a structured array of shape (cases,) with a float64 field
        for each input in `dispersed`, in the unit of its name. `cases`: number of cases, beginning with the first; default: all. Raises
        BadInput for more cases than the campaign has. For a larger campaign use `load(..., cases=...)`."""
        count = self.cases if cases is None else whole("cases", cases, 0, self.cases)
        return structured(_core.plan(self._core, count), self.dispersed)

    def fly(self, case=None, *, inputs=None, history=True, step_s=0.1, integrator="simpson", law=None, axes=("pitch",)):
        """Flies one case in this process, or the nominal flight if `case` is None. Returns a Flight.

        `inputs`: values by name, in the units of the names; they replace the drawn ones. `history`: whether to keep the
        time history. It has a row every `step_s` seconds (0.01 to 1e4, rounded to whole ticks of the autopilot) and at every
        event. Coasts are flown in strides of several ticks, so they have a row only where a stride ends at such a time.
        `integrator`: simpson (default of campaigns), erk4 or cvode.

        `law(tick)`: a control law of your own, for prototypes. It replaces the autopilot's law on `axes` (of roll, pitch
        and yaw). It is called at every tick of powered flight, and returns the commanded angular accelerations, rad/s²: a
        list, tuple or array of shape (3,) for roll, pitch and yaw, or one number if it commands one axis. Anything else is a
        TypeError.

        `tick` has these numbers: `time_s`, `since_ignition_s`, `stage` (from 1), and `limit_rad` of the nozzles. It has these
        arrays of roll, pitch and yaw: `angle_error_rad` and `rate_error_rad_s` (reference less true value, as the sensors
        measure it), `rate_rad_s`, `effectiveness_1_s2` (angular acceleration by deflection), `program_rad_s2`, `saturation`
        (-1, 0, 1), and the autopilot's gains `kp_1_s2` and `kd_1_s`. `telemetry` is four numbers for the history. `memory` is a
        dict that belongs to this flight.

        An exception of the law is raised here, with a note that names case and time. The call releases the interpreter's lock
        while it flies. Raises BadInput for an unknown case, input or integrator, and for a value that is not finite.
        """
        index = None if case is None else self._index(case)
        if not isinstance(integrator, str):
            raise refuse(f"integrator: {integrator!r} is not an integrator", "simpson, erk4 or cvode")
        values = _core.fly(self._core, index, self._replaced(inputs), _step(step_s) if history else 0.0, integrator, _law(law),
                           _axis_bits(axes))
        rows = values.pop("history")
        return Flight(self, index, values, None if rows is None else History(rows, values["history_columns"]))

    def fly_many(self, cases=None, *, histories=True, columns=None, step_s=1.0, threads=0, progress=None, law=None,
                 axes=("pitch",)):
        """Flies cases in this process, side by side on `threads` threads (0: the usable cores). Returns Flights.

        `cases`: the number of cases, beginning with the first, or their indices; default: all. `histories`: whether to keep
        the time histories, all in one array. `columns`: names of the columns to keep; default: all, half a kilobyte a row.
        `step_s`: as in fly. `progress(phase, done, total, note)` is called now and then; True shows a bar (tqdm).

        `law`, `axes`: as in fly. Calls for one flight alternate with calls for others, so a law keeps its state in
        `tick.memory`. The call releases the interpreter's lock; Ctrl-C stops it. Raises BadInput for an unknown case or
        column, and the exceptions of `progress` and of the law.
        """
        if cases is None:
            indices = list(range(self.cases))
        elif isinstance(cases, (str, bytes)) or not isinstance(cases, collections.abc.Iterable) or as_whole(cases) is not None:
            indices = list(range(whole("cases", cases, 0, self.cases)))
        else:
            indices = [self._index(case) for case in cases]
        values = _core.fly_many(self._core, indices, _step(step_s) if histories else 0.0,
                                None if columns is None else list(columns),
                                whole("threads", threads, 0, MOST_THREADS), progress_of(progress),
                                _law(law), _axis_bits(axes))
        return Flights(self, values)

    def _index(self, case):
        """A case's index as an int. Raises BadInput for one that the campaign does not have."""
        index = as_whole(case)
        if index is None or not 0 <= index < self.cases:
            raise refuse(f"case: the campaign has no case {case!r}", f"0 to {self.cases - 1}")
        return index

    def _replaced(self, inputs):
        """Values of inputs by name. Raises BadInput for a name or a value that is none."""
        values = {} if inputs is None else dict(inputs)
        for name in values:
            if name not in self.input_names:
                columns = [column for column, key in self.input_keys.items() if key == name]
                of = f", but the campaign file's name of {', '.join(columns)}" if columns else ""
                raise refuse(f"inputs: {name!r} is not an input of this vehicle{of}", "a name of Campaign.input_names")
        return {name: finite(f"inputs: {name}", value) for name, value in values.items()}


def _law(law):
    """A control law in Python, or None. Raises BadInput for what cannot be called."""
    if law is not None and not callable(law):
        raise refuse(f"law: {law!r} cannot be called", "a function of one argument")
    return law


def _axis_bits(axes):
    """A set of axes as the interface of control laws has it."""
    names = ("roll", "pitch", "yaw")
    chosen = {axes} if isinstance(axes, str) else set(axes)
    if not chosen or not chosen <= set(names):
        raise refuse(f"axes: {axes!r} are not axes", "some of roll, pitch and yaw")
    return sum(1 << names.index(name) for name in chosen)


def _step(step_s):
    return finite("step_s", step_s, 0.01, 1e4)


def _from_canonical(name, text):
    return Campaign(_core.from_canonical(name, text))


def under_law(campaign, law, axes=None):
    """(the campaign flown with this control law in Python, its SHA-256). `axes`: default pitch, or those that it was flown
    with. Raises BadInput for one that was flown with another law, or on other axes."""
    bits = None if axes is None else _axis_bits(axes)
    name, sha256 = identity(_law(law))
    if campaign.python_law is None:
        return Campaign(_core.under_law(campaign._core, _axis_bits("pitch") if bits is None else bits, name, sha256)), sha256
    flown_name, flown_sha256 = campaign.python_law
    if sha256 != flown_sha256:
        raise refuse(f"law: '{name}' (SHA-256 {sha256[:16]}…) is not the Python law that the campaign was flown with",
                     f"'{flown_name}' (SHA-256 {flown_sha256[:16]}…)")
    if bits is not None and bits != campaign._core.law_axes:
        raise refuse(f"axes: {axes!r} are not those that the campaign was flown with", "no axes")
    return campaign, sha256
