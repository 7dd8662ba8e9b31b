"""Columns with names over plain arrays."""
import numpy


def structured(array, names):
    """A C-contiguous array of shape (rows, columns) as a structured one of shape (rows,): the same memory, by name."""
    dtype = numpy.dtype([(name, array.dtype) for name in names])
    if not names:
        return numpy.empty(array.shape[0], dtype)
    return array.view(dtype).reshape(array.shape[0])
