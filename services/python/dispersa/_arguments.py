"""Arguments that are checked before C++ sees them, in the words of the program's errors."""
import difflib
import math
import operator

import numpy

from .errors import BadInput

MOST_CASES = 2**32 - 1
MOST_SEED = 2**64 - 1
MOST_THREADS = 1024


def refuse(message, allowed):
    """BadInput without a place in a file."""
    return BadInput([("", 0, 0, "", message, allowed)])


def did_you_mean(word, names):
    """" (did you mean 'x'?)" for the nearest of the names, else empty."""
    nearest = difflib.get_close_matches(str(word), names, n=1, cutoff=0.7)
    return f" (did you mean '{nearest[0]}'?)" if nearest else ""


def as_whole(value):
    """The int of a whole number of Python's or NumPy's; None for what is none, such as a truth."""
    try:
        return None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        return None


def whole(name, value, least=0, most=MOST_SEED):
    """A whole number in a range."""
    number = as_whole(value)
    if number is None:
        raise refuse(f"{name}: {value!r} is not a whole number", f"a whole number from {least} to {most}")
    if not least <= number <= most:
        raise refuse(f"{name}: {number} is out of range", f"a whole number from {least} to {most}")
    return number


def whole_if_given(name, value, least=0, most=MOST_SEED):
    """The same; None stays None."""
    return None if value is None else whole(name, value, least, most)


def finite(name, value, least=-math.inf, most=math.inf):
    """A finite number in a range, as a float."""
    allowed = "a finite number" if most == math.inf else f"{least:g} to {most:g}"
    try:
        number = math.nan if isinstance(value, (str, bytes, bool)) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise refuse(f"{name}: {value!r} is no finite number", allowed)
    if not least <= number <= most:
        raise refuse(f"{name}: {number} is out of range", allowed)
    return number


def truth(name, value):
    """True or False, of Python's or NumPy's."""
    if not isinstance(value, (bool, numpy.bool_)):
        raise refuse(f"{name}: {value!r} is neither True nor False", "True or False")
    return bool(value)
