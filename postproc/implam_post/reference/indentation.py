"""Indentation law of laminate and impactor."""

from dataclasses import dataclass


@dataclass
class IndentationLaw:
    """Force against indentation with state variables: Hertz's law, or Tan and Sun's law with permanent indentation.

    First loading follows F = k alpha**1.5 up to (alpha_m, F_m). Unloading, and reloading without separation, follow
    F_m [(alpha - alpha_0)/(alpha_m - alpha_0)]**q. After separation the exponent is that of reloading.
    """

    stiffness: float
    hertz: bool = False
    unloading: float = 2.5
    reloading: float = 1.5
    slope: float = 0.094
    critical: float = 0.0
    dent: str = "tan_sun"
    largest: float = 0.0
    largest_force: float = 0.0
    permanent: float = 0.0
    exponent: float = 1.5

    def force(self, indentation: float) -> float:
        """Return the force at an indentation, from the last committed state."""
        if indentation <= self.permanent:
            return 0.0
        if self.hertz or indentation >= self.largest:
            return self.stiffness * indentation**1.5
        return self.largest_force * ((indentation - self.permanent) / (self.largest - self.permanent))**self.exponent

    def commit(self, indentation: float) -> None:
        """Commit an indentation: update the largest and the permanent indentation, and the separation."""
        if self.hertz:
            return
        if indentation > self.largest:
            self.largest, self.largest_force = indentation, self.force(indentation)
            self.permanent = self._dent()
            self.exponent = self.unloading
        elif indentation <= self.permanent:
            self.exponent = self.reloading

    def _dent(self) -> float:
        """Return the permanent indentation after the largest one."""
        if self.largest <= self.critical:
            return 0.0
        if self.dent == "yang_sun":
            return self.largest * (1 - (self.critical / self.largest)**0.4)
        return self.slope * (self.largest - self.critical)
