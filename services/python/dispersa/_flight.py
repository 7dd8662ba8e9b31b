"""Results of flights: outcomes, inputs, metrics, time histories."""
import difflib
import operator

import numpy

from ._tables import structured
from .errors import BadInput

FLIGHT_VALUES = ("outcome", "end_time_s", "end_stage", "reason", "digest", "inputs", "metrics")


class History:
    """The time history of one flight: rows at the output step and at every event.

    `rows` is a float64 array of shape (rows, columns). It has the columns of flights under the flown control law.
    `history["altitude_m"]` is a column of it, a view of shape (rows,). NaN: undefined.
    """

    def __init__(self, rows, columns):
        self.rows = rows
        self.columns = list(columns)
        self._positions = {name: i for i, name in enumerate(self.columns)}

    def __repr__(self):
        return f"<dispersa.History: {self.rows.shape[0]} rows of {len(self.columns)} columns>"

    def __len__(self):
        return self.rows.shape[0]

    def __contains__(self, name):
        return name in self._positions

    def __getitem__(self, name):
        try:
            return self.rows[:, self._positions[name]]
        except KeyError:
            near = ", ".join(difflib.get_close_matches(str(name), self.columns))
            raise KeyError(f"the history has no column {name!r}" + (f"; there is {near}" if near else "")) from None

    def frame(self):
        """A pandas.DataFrame of shape (rows, columns) over the same memory. Needs pandas."""
        import pandas
        return pandas.DataFrame(self.rows, columns=self.columns, copy=False)


class Flight:
    """One flight.

    `case`: its index, None for the nominal flight. `outcome`: "completed", "lost_control", ...; `reason`: one sentence,
    empty when completed; `end_time_s`: since lift-off; `end_stage`: from 1. `inputs`, `metrics`: dicts of floats, in the
    units of their names; an undefined metric is NaN. `digest`: of the flight's bits, 32 hexadecimal digits. `history`: a
    History, or None.
    """

    def __init__(self, campaign, case, values, history):
        self.case = case
        self.outcome = values["outcome"]
        self.end_time_s = float(values["end_time_s"])
        self.end_stage = int(values["end_stage"])
        self.reason = values["reason"]
        self.digest = values["digest"]
        self.inputs = dict(zip(campaign.input_names, values["inputs"].tolist()))
        self.metrics = dict(zip(values["metric_names"], values["metrics"].tolist()))
        self.history = history

    def __repr__(self):
        who = "nominal" if self.case is None else f"case {self.case}"
        return f"<dispersa.Flight {who}: {self.outcome} at {self.end_time_s:.2f} s>"

    @property
    def completed(self):
        """Whether the flight reached the end of the last burn: `outcome` is "completed"."""
        return self.outcome == "completed"


class Flights:
    """Many flights, a sequence of Flight; a slice of it is a list.

    `cases`: indices, shape (flights,). `outcome`: names. `inputs`, `metrics`: structured arrays of shape (flights,) with a
    float64 field for each name. `histories`: the rows of all flights, one flight after the other, as one float64 array of
    shape (total rows, columns), not a copy. Flight i has rows offsets[i] to offsets[i + 1]. Without histories both are None.
    """

    def __init__(self, campaign, values):
        self._campaign = campaign
        self._values = values
        self.cases = values["case_index"]
        self.outcome = values["outcome"]
        self.inputs = structured(values["inputs"], campaign.input_names)
        self.metrics = structured(values["metrics"], values["metric_names"])
        self.columns = values["history_columns"]
        self.histories = values.get("histories")
        self.offsets = values.get("offsets")

    def __repr__(self):
        return f"<dispersa.Flights of {self._campaign.name}: {len(self)}, {self.outcome.count('completed')} completed>"

    def __len__(self):
        return len(self.cases)

    def __iter__(self):
        return (self[i] for i in range(len(self)))

    def __getitem__(self, i):
        if isinstance(i, slice):
            return [self[each] for each in range(len(self))[i]]
        i = self._position(i)
        values = {name: self._values[name][i] for name in FLIGHT_VALUES}
        return Flight(self._campaign, int(self.cases[i]), values | {"metric_names": self._values["metric_names"]},
                      self.history(i))

    def _position(self, i):
        """The history of flight i; a negative i counts from the end. Raises IndexError."""
        try:
            return range(len(self))[operator.index(i)]
        except IndexError:
            raise IndexError(f"there is no flight {i} of {len(self)}") from None

    def history(self, i):
        """The History of flight i (a position, not a case's index; -1: the last): rows of `histories`, not a copy. None
        without histories."""
        i = self._position(i)
        if self.histories is None:
            return None
        return History(self.histories[self.offsets[i]:self.offsets[i + 1]], self.columns)

    def sample(self, column, times_s):
        """A column of every flight at these times, linear between rows, NaN after the flight's end: shape (flights, times).
        Raises BadInput if the histories lack `time_s` or the column."""
        times = numpy.asarray(times_s, dtype=float)
        if self.histories is None or not {"time_s", column} <= set(self.columns):
            raise BadInput(f"sample: the flights have no histories with time_s and {column}")
        sampled = numpy.empty((len(self), times.size))
        for i in range(len(self)):
            history = self.history(i)
            sampled[i] = numpy.interp(times, history["time_s"], history[column], right=numpy.nan)
        return sampled
