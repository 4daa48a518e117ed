"""Numbers for predicates that are to be right for all finite ones: strategies of hypothesis."""

from hypothesis import strategies as st

EDGES = [0.0, 5e-324, 2.0**-1074 * 3, 2.0**-1022, 1e-200, 1e-160, 1e-136, 1.0, 1e150, 1e300]
finite = st.floats(allow_nan=False, allow_infinity=False)
sized = st.one_of(finite, st.sampled_from([*EDGES, *(-x for x in EDGES), 1.7976931348623157e308]))
powers = st.one_of(st.integers(-1074, 960), st.sampled_from([-1074, -1040, -540, -450, -300, 500]))
small = st.integers(-(2**12), 2**12)
few = st.integers(-3, 3)
