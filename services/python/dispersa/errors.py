"""The exit codes of the program, and an exception for each code that is not a verdict."""
import dataclasses
import enum


class ExitCode(enum.IntEnum):
    """The program's exit codes. Those of a verdict are values of results; the others are exceptions."""

    DONE = 0
    INTERNAL_ERROR = 1
    BAD_INPUT = 2
    REQUIREMENT_FAILED = 3
    INCONCLUSIVE = 4
    INCOMPLETE = 5
    REPLAY_MISMATCH = 6
    NOT_EVIDENCE = 7
    INTERRUPTED = 130


@dataclasses.dataclass(frozen=True)
class Problem:
    """One error or warning of an input. Line and column count from 1; 0: the problem has no place in a text."""

    file: str
    """The file's name as it was given; for a dict FOLDER/<dict>."""
    line: int
    """From 1."""
    column: int
    """From 1."""
    path: str
    """The value's path in its file, such as "stages[1].motor.thrust_kn"; empty: the file as a whole."""
    message: str
    """The fault."""
    allowed: str
    """The allowed values; for a warning the usual ones. May be empty."""

    def __str__(self):
        place = f"{self.file}:{self.line}:{self.column}: " if self.line else f"{self.file}: " if self.file else ""
        return (place + (f"{self.path}: " if self.path else "") + self.message
                + (f", allowed: {self.allowed}" if self.allowed else ""))


class Error(Exception):
    """An error for which the program would end with exit code `code`."""

    code = ExitCode.INTERNAL_ERROR


class BadInput(Error, ValueError):
    """Bad usage or bad input (2); `problems` has every problem that was found."""

    code = ExitCode.BAD_INPUT

    def __init__(self, problems):
        if isinstance(problems, str):
            problems = [("", 0, 0, "", problems, "")]
        self.problems = [p if isinstance(p, Problem) else Problem(*p) for p in problems]
        super().__init__("\n".join(map(str, self.problems)))

    def __reduce__(self):
        return type(self), (self.problems,)


class Incomplete(Error):
    """Cases are missing (5): no workers, disk full, quarantined, cancelled. `results`: the stored Results, or None."""

    code = ExitCode.INCOMPLETE
    results = None


class ReplayMismatch(Error):
    """A replayed case differs from the stored one (6); `differences`: dicts of name, stored, replayed."""

    code = ExitCode.REPLAY_MISMATCH
    differences = ()


class InternalError(Error, RuntimeError):
    """An error of the program or of the machine (1). `results`: the stored Results, or None."""

    results = None


class InputWarning(UserWarning):
    """A value of an input is allowed, but looks wrong."""
