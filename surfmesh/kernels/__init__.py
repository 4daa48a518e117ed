"""Compiled kernels: arrays in, arrays and a status out. Nothing here knows sympy, scipy or OCP.

jit: the one decorator that compiles every kernel.
fields: size tensors, their gradation, and the look-up in a background.
triangulation: the triangulation of the plane, its predicates, and its local changes.

Conventions, once for all kernels
---------------------------------
- Angles are in radians, indices start at 0, ``NIL = -1`` means "none".
- Points live in the *scaled* parameter plane: (x, y) = (u, v) times one factor each, so that
  the mean first fundamental form has equal diagonal entries.
- A size tensor H is symmetric positive definite and stored as three numbers (h11, h12, h22).
  The "circle" of a vertex p is the ellipse |H(p)^-1 (x - p)| <= 1/2.
- The metric length of pq is | ((H(p) + H(q)) / 2)^-1 (q - p) |; two circles touch at length 1.
- Triangles are counter-clockwise. Half-edge e = 3 t + i runs from ``tri[e]`` to
  ``tri[next(e)]``; ``adj[e]`` is its twin in the neighbouring triangle:

              c                       tri[3t] = a, tri[3t+1] = b, tri[3t+2] = c
             / \\
     3t+2   /   \\  3t+1              next(e) = e + 1, or e - 2 for the last of three
           /  t  \\                   prev(e) = e - 1, or e + 2 for the first of three
          a ----- b
             3t

- The triangulation covers the whole plane: a hull edge a-b has a *ghost triangle* (b, a, NIL)
  on its outer side, so every half-edge has a twin.
- The front is one loop, counter-clockwise, with what is done on its left:

       prev[a] --> a --> b = next[a]         done: left of a -> b
                 edge[a] = half-edge of the done triangle that runs from a to b
"""

NIL = -1
