import contextlib
from typing import Any, Sequence

import numpy
import numpy.typing
from matplotlib.axes import Axes

from . import Flight, Flights, History, Results

_Flown = Flight | History | Flights | Sequence[Flight | History]
_Panels = numpy.typing.NDArray[numpy.object_]

INK: str
SOFT: str
RULE: str
PANEL: str
LINES: tuple[str, ...]
LIMIT: str
OUTER: str
INNER: str
STYLE: dict[str, Any]
TIME: str
COAST_S: float

def style() -> contextlib.AbstractContextManager[None]: ...
def label(name: str) -> str: ...
def history(flights: _Flown, columns: str | Sequence[str], *, labels: Sequence[str] | None = ...,
            axes: Any = ...) -> _Panels: ...
def bands(what: Results | Flights, column: str, *, nominal: bool = ..., ax: Axes | None = ...) -> Axes: ...
def exceedance(results: Results, metric: str, *, ax: Axes | None = ...) -> Axes: ...
def drivers(results: Results, metric: str, *, count: int = ..., axes: Any = ...) -> _Panels: ...
def ground_track(flights: _Flown, *, labels: Sequence[str] | None = ..., ax: Axes | None = ...) -> Axes: ...
