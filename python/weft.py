"""Weft's materials as functions of NumPy arrays, over the shared library libweft (ctypes).

    >>> import weft
    >>> cloth = weft.open("cloth.weft")
    >>> cloth.eval(u, v, light, view)          # BRDF in 1/sr, linear sRGB, without the cosine: shape (..., 3)

Directions are arrays (..., 3) in the frame of the surface: x along the weft, y along the warp, z its normal; they point
away from the surface and need not be unit vectors. All arguments broadcast. WEFT_LIBRARY names another libweft.so.
"""
import ctypes
import os

import numpy as np

_MESSAGE_SIZE = 512
_lib = ctypes.CDLL(os.environ.get("WEFT_LIBRARY", "libweft.so.0"))


class _Error(ctypes.Structure):
    _fields_ = [("code", ctypes.c_int), ("message", ctypes.c_char * _MESSAGE_SIZE)]


class _Options(ctypes.Structure):
    _fields_ = [("noise_seed", ctypes.c_uint64), ("parameter", ctypes.c_void_p), ("parameter_count", ctypes.c_int),
                ("interval", ctypes.c_bool), ("lobes", ctypes.c_bool), ("flat", ctypes.c_bool),
                ("as_printed", ctypes.c_bool)]


class Error(Exception):
    """What the library says; `code` is a weft_code of weft/status.h."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


_handle, _array = ctypes.c_void_p, ctypes.POINTER(ctypes.c_double)
_lib.weft_version.restype = ctypes.c_char_p
_lib.weft_model_open.argtypes = [ctypes.c_char_p, ctypes.POINTER(_Options), ctypes.POINTER(_handle), ctypes.POINTER(_Error)]
_lib.weft_model_close.argtypes = [_handle]
_lib.weft_model_close.restype = None
_lib.weft_model_level_count.argtypes = [_handle]
_lib.weft_model_level_of_footprint.argtypes = [_handle, _array]
_lib.weft_model_level_of_footprint.restype = ctypes.c_double
_lib.weft_evaluate.argtypes = [_handle, ctypes.c_size_t] + 5 * [_array] + [ctypes.POINTER(_Error)]
_lib.weft_evaluate_opacity.argtypes = [_handle, ctypes.c_size_t] + 4 * [_array] + [ctypes.POINTER(_Error)]

version = _lib.weft_version().decode()


def _call(function, *arguments):
    error = _Error()
    if function(*arguments, ctypes.byref(error)) != 0:
        raise Error(error.code, error.message.decode())


def _together(values, vectors):
    """All broadcast to one shape, as contiguous doubles: values (...), vectors (..., 3)."""
    values = [np.asarray(a, float) for a in values]
    vectors = [np.asarray(a, float) for a in vectors]
    if any(a.ndim < 1 or a.shape[-1] != 3 for a in vectors):
        raise ValueError("a direction is an array (..., 3)")
    shape = np.broadcast_shapes(*[a.shape for a in values], *[a.shape[:-1] for a in vectors])
    return (shape, [np.ascontiguousarray(np.broadcast_to(a, shape)) for a in values],
            [np.ascontiguousarray(np.broadcast_to(a, shape + (3,))) for a in vectors])


def _pointer(array):
    return None if array is None else array.ctypes.data_as(_array)


class Model:
    """A material (.weft), a dataset (.btf.h5), a weave (.wv) or a cloth of microcylinders (.mc)."""

    def __init__(self, path, noise_seed=0, lobes=False, flat=False):
        self._model = _handle()
        options = _Options(noise_seed=noise_seed, lobes=lobes, flat=flat)
        _call(_lib.weft_model_open, os.fsencode(path), ctypes.byref(options), ctypes.byref(self._model))

    def __del__(self):
        if getattr(self, "_model", None):
            _lib.weft_model_close(self._model)

    @property
    def level_count(self):
        return _lib.weft_model_level_count(self._model)

    def level_of_footprint(self, du_dx, dv_dx, du_dy, dv_dy):
        """The mip level for a pixel that covers so much of the material."""
        return _lib.weft_model_level_of_footprint(self._model, (ctypes.c_double * 4)(du_dx, dv_dx, du_dy, dv_dy))

    def eval(self, u, v, light, view, level=0):
        """BRDF in 1/sr at texture coordinates (u, v), which repeat, on a mip level, which may be fractional."""
        shape, (u, v, level), (light, view) = _together((u, v, level), (light, view))
        uv, brdf = np.stack([u, v], axis=-1), np.empty(shape + (3,))
        _call(_lib.weft_evaluate, self._model, u.size, *map(_pointer, (uv, level, light, view, brdf)))
        return brdf

    def mean(self, light, view, level=0):
        """The mean BRDF over all of the model."""
        shape, (level,), (light, view) = _together((level,), (light, view))
        brdf = np.empty(shape + (3,))
        _call(_lib.weft_evaluate, self._model, level.size, *map(_pointer, (None, level, light, view, brdf)))
        return brdf

    def opacity(self, u, v, view, level=0):
        """Opacity, 0 .. 1."""
        shape, (u, v, level), (view,) = _together((u, v, level), (view,))
        uv, opacity = np.stack([u, v], axis=-1), np.empty(shape)
        _call(_lib.weft_evaluate_opacity, self._model, u.size, *map(_pointer, (uv, level, view, opacity)))
        return opacity


open = Model
