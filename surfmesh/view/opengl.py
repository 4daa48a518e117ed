"""Whether VTK can draw here. Where it cannot it ends the process, so it must not be tried."""

import ctypes
import os
import sys
from functools import cache

SURFACELESS = 0x31DD  # EGL_PLATFORM_SURFACELESS_MESA


@cache
def can_draw() -> bool:
    """True with a display, or with an EGL library that starts without one."""
    if sys.platform != "linux" or os.environ.get("DISPLAY"):
        return True
    try:
        egl = ctypes.CDLL("libEGL.so.1")
        egl.eglGetPlatformDisplay.restype = ctypes.c_void_p
        egl.eglGetPlatformDisplay.argtypes = [ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p]
        egl.eglGetDisplay.restype = ctypes.c_void_p
        egl.eglGetDisplay.argtypes = [ctypes.c_void_p]
        egl.eglInitialize.argtypes = [ctypes.c_void_p] * 3
    except (OSError, AttributeError):
        return False
    displays = (egl.eglGetPlatformDisplay(SURFACELESS, None, None), egl.eglGetDisplay(None))
    return any(display and egl.eglInitialize(display, None, None) for display in displays)
