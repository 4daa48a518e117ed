"""
Sine, cosine, exponential and the like: one implementation, the same bits everywhere.
"""

from typing import Annotated, overload

import numpy
from numpy.typing import NDArray


@overload
def sin(x: float) -> float:
    """Sine; error below 0.85 ulp."""

@overload
def sin(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def cos(x: float) -> float:
    """Cosine; error below 0.85 ulp."""

@overload
def cos(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def tan(x: float) -> float:
    """Tangent; error below 1 ulp."""

@overload
def tan(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def sincos(x: float) -> tuple[float, float]:
    """Sine and cosine, those of ``sin`` and ``cos``."""

@overload
def sincos(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
    """Likewise, for each number of an array."""

@overload
def exp(x: float) -> float:
    """Exponential; error below 0.7 ulp."""

@overload
def exp(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def log(x: float) -> float:
    """Natural logarithm; error below 0.6 ulp; nan below 0."""

@overload
def log(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def sinh(x: float) -> float:
    """Hyperbolic sine; error below 1.5 ulp."""

@overload
def sinh(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def cosh(x: float) -> float:
    """Hyperbolic cosine; error below 1.5 ulp."""

@overload
def cosh(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def tanh(x: float) -> float:
    """Hyperbolic tangent; error below 1.5 ulp."""

@overload
def tanh(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def asinh(x: float) -> float:
    """Inverse of sinh; error below 1 ulp."""

@overload
def asinh(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def acosh(x: float) -> float:
    """Inverse of cosh; error below 1 ulp; nan below 1."""

@overload
def acosh(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def atanh(x: float) -> float:
    """Inverse of tanh; error below 1 ulp; nan outside [-1, 1]."""

@overload
def atanh(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def asin(x: float) -> float:
    """Arcus sine; error below 1.5 ulp; nan outside [-1, 1]."""

@overload
def asin(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def acos(x: float) -> float:
    """Arcus cosine; error below 1.5 ulp; nan outside [-1, 1]."""

@overload
def acos(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def atan(x: float) -> float:
    """Arcus tangent; error below 0.7 ulp."""

@overload
def atan(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def atan2(y: float, x: float) -> float:
    """The angle of the point (x, y), in [-pi, pi]; error below 0.7 ulp."""

@overload
def atan2(y: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each pair of two arrays of one shape."""

@overload
def pow(x: float, y: float) -> float:
    """x to the power y; error below 1 ulp; nan for x < 0 unless y is whole."""

@overload
def pow(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each pair of two arrays of one shape."""

@overload
def hypot(x: float, y: float) -> float:
    """sqrt(x^2 + y^2) without overflow on the way; error below 0.51 ulp."""

@overload
def hypot(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each pair of two arrays of one shape."""

@overload
def cbrt(x: float) -> float:
    """Cube root, of either sign; error below 0.51 ulp."""

@overload
def cbrt(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def erf(x: float) -> float:
    """The error function; error below 1 ulp."""

@overload
def erf(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def bessel_0(x: float) -> float:
    """Spherical Bessel function j0 = sin(x)/x, 1 at 0."""

@overload
def bessel_0(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def bessel_1(x: float) -> float:
    """Spherical Bessel function j1."""

@overload
def bessel_1(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def bessel_2(x: float) -> float:
    """Spherical Bessel function j2."""

@overload
def bessel_2(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""
