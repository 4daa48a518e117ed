"""A grammar of formulas: allowed ones, and ones that are nearly allowed.

Every choice is drawn from one generator, so that a seed names a formula for ever.
"""

import random

DEEPEST = 5
FUNCTIONS = (
    "sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp log sqrt cbrt abs sign floor "
    "erf sinc sec cot log10 heaviside ceil"
).split()
PAIRS = "atan2 hypot min max".split()
NUMBERS = (
    "0 1 2 3 0.5 1e-9 1e9 1e-300 1e300 60 64 1/3 -1 pi e tau 0.1234567890123 1e30 100 7 1e16"
).split()
NEARLY = (
    "1e400 10**400 9**9**9 u. u.real 2u (u u) , ** sin sin() sin(u,v) log(-1) 1/0 0/0 nan inf oo "
    "u%2 u//2 u<v u=v [u] {u} 'u' lambda:u __import__ w u² π １ u!v \x00 \x1b[31m \u202e 0x1f 1e5e5"
).split()
DOMAINS = (
    ((-1, 1), (-1, 1)), ((0, 1), (0, 2)), ((0.1, 1), (0.2, 1)), ((0, "2*pi"), (0, "pi")),
    ((-1e9, 1e9), (-1, 1)), ((0, 1e-9), (0, 1e-9)), ((1, 1 + 1e-9), (0, 1)),
)  # fmt: skip


class Grammar:
    """Formulas of one seed, one after the other."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def surface(self) -> dict:
        """Arguments of a surface: as a rule a graph over (u, v), now and then three formulas."""
        pick = self.random
        x, y, z = "u", "v", self.formula()
        if pick.random() < 0.2:
            x, y = self.formula(3), self.formula(3)
        u, v = pick.choice(DOMAINS)
        return {"x": x, "y": y, "z": z, "u": u, "v": v}

    def formula(self, depth: int = DEEPEST) -> str:
        if self.random.random() < 0.08:
            return self._spoilt(self._sum(depth))
        return self._long() if self.random.random() < 0.08 else self._sum(depth)

    def _sum(self, depth: int) -> str:
        pick = self.random
        if depth <= 0 or pick.random() < 0.15:
            return pick.choice(["u", "v", "u", "v", pick.choice(NUMBERS)])
        form = pick.randrange(8)
        if form < 3:
            return f"({self._sum(depth - 1)} {pick.choice('+-*/')} {self._sum(depth - 1)})"
        if form < 5:
            return f"{pick.choice(FUNCTIONS)}({self._sum(depth - 1)})"
        if form == 5:
            return f"{pick.choice(PAIRS)}({self._sum(depth - 1)}, {self._sum(depth - 1)})"
        if form == 6:
            exponent = pick.choice(["2", "3", "-1", "0.5", "0.1", "64", "-2.5", "1e-3", "u", "v"])
            return f"({self._sum(depth - 1)})**{exponent}"
        return f"-{self._sum(depth - 1)}"

    def _long(self) -> str:
        """Long sums, products and nests of one small part with numbers in it."""
        pick = self.random
        part = self._sum(2)
        count = pick.choice([20, 50, 120])
        parts = [part.replace("u", f"({k}*u+{k % 7}*v)") for k in range(1, count + 1)]
        if pick.random() < 0.3:
            deep = pick.choice([12, 30, 59])
            return f"{pick.choice(FUNCTIONS)}(" * deep + "u+v" + ")" * deep
        return pick.choice("+*").join(parts)

    def _spoilt(self, text: str) -> str:
        pick = self.random
        place = pick.randrange(len(text) + 1)
        if pick.random() < 0.3:
            return text[:place] + text[place + 1 :]
        return text[:place] + pick.choice(NEARLY) + text[place:]
