import dataclasses
import enum
from typing import Any, ClassVar, Iterable, Sequence

class ExitCode(enum.IntEnum):
    DONE = 0
    INTERNAL_ERROR = 1
    BAD_INPUT = 2
    REQUIREMENT_FAILED = 3
    INCONCLUSIVE = 4
    INCOMPLETE = 5
    REPLAY_MISMATCH = 6
    INTERRUPTED = 130

@dataclasses.dataclass(frozen=True)
class Problem:
    file: str
    line: int
    column: int
    path: str
    message: str
    allowed: str

class Error(Exception):
    code: ClassVar[ExitCode]

class BadInput(Error, ValueError):
    problems: list[Problem]
    def __init__(self, problems: str | Iterable[Problem | tuple[str, int, int, str, str, str]]) -> None: ...

class Incomplete(Error):
    results: Any

class ReplayMismatch(Error):
    differences: Sequence[dict[str, str]]

class InternalError(Error, RuntimeError):
    results: Any

class InputWarning(UserWarning): ...
