"""Semi-analytic response of an elastic impact: a ball on a simply supported cross-ply plate, by Navier's modes.

The plate is Mindlin's with rotary inertia; if it is curved, a shallow shell after Donnell with Navier's edges and with
the inertia of its in-plane displacements, the force is spread over a square patch in the centre, and the indentation
is measured from the patch's mean deflection. Modes and ball are integrated exactly under a force that
is linear over a step; the force at the end of a step is the root of a scalar equation. Modes of frequencies far above
those of the force are static.
"""
import dataclasses
import math

import numpy as np


@dataclasses.dataclass
class Model:
    """One impact, in SI units. Plies are symmetric about the mid-plane, angles 0 or 90."""

    length: tuple
    angles: list
    ply: float  # thickness of each, or a list of thicknesses
    moduli: tuple  # E1, E2, G12, G13, G23, nu12
    density: float
    mass: float
    velocity: float
    radius: float
    k: float
    law: str = 'hertz'  # hertz, tan_sun or yang_sun
    alpha_cr: float = 80.3e-6
    q: float = 2.5
    beta: float = 0.094
    curvature: tuple = (0.0, 0.0)  # of the lines along x and along y
    name: str = 'model'

    @property
    def thickness(self):
        return float(np.sum(self.plies))

    @property
    def plies(self):
        return np.broadcast_to(self.ply, len(self.angles))

    def contact_time(self):
        """tau: the rise time, after which the wave impedance of the plate carries the contact force."""
        bending = (self.moduli[0] + self.moduli[1])/2*self.thickness**3/12
        impedance = 8*math.sqrt(bending*self.density*self.thickness)
        tau = (impedance*self.velocity/self.k)**(2/3)/self.velocity
        return min(tau, 2.9432*(1.25*self.mass/self.k)**0.4/self.velocity**0.2/2)


def section(model):
    """Bending stiffnesses D11, D12, D22, D66, shear stiffnesses xz and yz with 5/6, mass and rotary inertia."""
    e1, e2, g12, g13, g23, nu12 = model.moduli
    nu21 = nu12*e2/e1
    q11, q22, q12 = e1/(1 - nu12*nu21), e2/(1 - nu12*nu21), nu12*e2/(1 - nu12*nu21)
    h = model.thickness
    z = np.cumsum(np.append(-h/2, model.plies))
    third = (z[1:]**3 - z[:-1]**3)/3
    along = np.array(model.angles) == 0
    bending = (sum(third*np.where(along, q11, q22)), q12*sum(third), sum(third*np.where(along, q22, q11)),
               g12*sum(third))
    shear = (5/6*sum(model.plies*np.where(along, g13, g23)), 5/6*sum(model.plies*np.where(along, g23, g13)))
    return bending, shear, model.density*h, model.density*h**3/12


def matrices(model, m, n):
    """Entries of the stiffness of modes m, n for deflection and two rotations, as arrays."""
    (d11, d12, d22, d66), (sx, sy), _, _ = section(model)
    a, b = m*math.pi/model.length[0], n*math.pi/model.length[1]
    return (sx*a**2 + sy*b**2, sx*a, sy*b, d11*a**2 + d66*b**2 + sx, (d12 + d66)*a*b, d66*a**2 + d22*b**2 + sy)


def membrane(model, m, n):
    """Stiffness of deflection and in-plane displacements u, v of a curved plate: ww, wu, wv, uu, uv, vv."""
    e1, e2, g12, _, _, nu12 = model.moduli
    nu21 = nu12*e2/e1
    along = np.array(model.angles) == 0
    q11, q22, a12 = (e1/(1 - nu12*nu21), e2/(1 - nu12*nu21), nu12*e2/(1 - nu12*nu21)*model.thickness)
    a11, a22 = sum(model.plies*np.where(along, q11, q22)), sum(model.plies*np.where(along, q22, q11))
    a66 = g12*model.thickness
    a, b = m*math.pi/model.length[0], n*math.pi/model.length[1]
    x, y = model.curvature
    return (a11*x**2 + 2*a12*x*y + a22*y**2 + 0*a*b, (a11*x + a12*y)*a, (a12*x + a22*y)*b, a11*a**2 + a66*b**2,
            (a12 + a66)*a*b, a66*a**2 + a22*b**2)


def condensed(model, m, n):
    """Stiffness of the deflection with the rotations, and in-plane displacements, condensed out."""
    k11, k12, k13, k22, k23, k33 = matrices(model, m, n)
    det = k22*k33 - k23**2
    bending = k11 - (k12**2*k33 - 2*k12*k13*k23 + k13**2*k22)/det
    if not any(model.curvature):
        return bending
    k11, k12, k13, k22, k23, k33 = membrane(model, m, n)
    return bending + k11 - (k12**2*k33 - 2*k12*k13*k23 + k13**2*k22)/(k22*k33 - k23**2)


def patch_weight(model, patch, m, n):
    """Square of a mode's mean over the patch, over its norm."""
    x, y = m*patch/model.length[0]/2, n*patch/model.length[1]/2
    return 4/np.prod(model.length)*(np.sinc(x)*np.sinc(y))**2


def modes(model, patch, cutoff):
    """Frequencies and weights of the modes up to a frequency, and the compliance of all others."""
    _, _, mass, rotary = section(model)
    sizes = [int(6*length/patch) + 40 for length in model.length]
    m, n = np.meshgrid(np.arange(1, sizes[0], 2.0), np.arange(1, sizes[1], 2.0), indexing='ij')
    stiffness = condensed(model, m, n)
    weight = patch_weight(model, patch, m, n)
    static = np.sum(weight/stiffness)
    near = stiffness/mass < 4*cutoff**2
    m, n, weight = m[near], n[near], weight[near]
    k11, k12, k13, k22, k23, k33 = matrices(model, m, n)
    scale = np.array([mass, rotary, rotary])**-0.5
    full = np.array([[k11, k12, k13], [k12, k22, k23], [k13, k23, k33]]).transpose(2, 0, 1)
    if any(model.curvature):
        ww, wu, wv, uu, uv, vv = membrane(model, m, n)
        scale = np.append(scale, [mass**-0.5, mass**-0.5])
        full = np.pad(full, ((0, 0), (0, 2), (0, 2)))
        full[:, 0, 0] += ww
        full[:, 0, 3:] = full[:, 3:, 0] = np.array([wu, wv]).T
        full[:, 3:, 3:] = np.array([[uu, uv], [uv, vv]]).transpose(2, 0, 1)
    full = full*scale[:, None]*scale
    squares, vectors = np.linalg.eigh(full)
    omega = np.sqrt(np.abs(squares)).ravel()
    weight = (weight[:, None]*vectors[:, 0, :]**2/mass).ravel()
    kept = (omega < cutoff) & (weight > 0)
    omega, weight = omega[kept], weight[kept]
    return omega, weight, static - np.sum(weight/omega**2)


class Contact:
    """The indentation law with its history variables."""

    def __init__(self, model):
        self.model, self.alpha_max, self.dent, self.separated = model, 0.0, 0.0, False

    def force(self, alpha):
        s = self.model
        if s.law == 'hertz' or alpha >= self.alpha_max:
            return s.k*max(alpha, 0.0)**1.5
        if alpha <= self.dent:
            return 0.0
        part = (alpha - self.dent)/(self.alpha_max - self.dent)
        return s.k*self.alpha_max**1.5*part**(1.5 if self.separated else s.q)

    def commit(self, alpha):
        s = self.model
        if alpha > self.alpha_max:
            self.alpha_max, self.separated = alpha, False
            if alpha > s.alpha_cr:
                self.dent = (s.beta*(alpha - s.alpha_cr) if s.law == 'tan_sun'
                             else alpha*(1 - (s.alpha_cr/alpha)**0.4))
            if s.law == 'hertz':
                self.dent = 0.0
        elif alpha <= self.dent and self.alpha_max > 0:
            self.separated = True

    def solve(self, free, compliance):
        """Force F at which F = force(free - compliance F)."""
        top = self.force(free)
        if top <= 0:
            return 0.0
        low, high = 0.0, min(top, free/compliance)
        force = high/2
        for _ in range(100):
            alpha = free - compliance*force
            rest = self.force(alpha) - force
            if rest > 0:
                low = force
            else:
                high = force
            step = 1e-6*max(abs(alpha), 1e-12)
            slope = (self.force(alpha + step) - self.force(alpha))/step*compliance + 1
            new = force + rest/slope
            if not low < new < high:
                new = (low + high)/2
            if abs(new - force) < 1e-12*top:
                return new
            force = new
        return force


def response(model, patch, end, fineness=100, cutoff=60):
    """Times and forces of the response, the ball's velocity and the patch's deflection, from first contact to `end`."""
    tau = model.contact_time()
    dt = tau/fineness
    steps = math.ceil(end/dt)
    dt = end/steps
    omega, weight, static = modes(model, patch, cutoff/tau)
    x = omega*dt
    c, s = np.cos(x), np.sin(x)
    # Under F0 + (F1 - F0) t/dt a mode ends at c q + s v/omega + start F0 + finish F1.
    finish = weight/omega**2*(1 - np.sinc(x/math.pi))
    start = weight/omega**2*(np.sinc(x/math.pi) - c)
    rate_finish = weight/omega*(1 - c)/x
    rate_start = weight/omega*(s - (1 - c)/x)
    slow = s/omega
    q, v = np.zeros_like(omega), np.zeros_like(omega)
    ball, speed = 0.0, model.velocity
    compliance = np.sum(finish) + static + dt**2/6/model.mass
    contact = Contact(model)
    times, forces = np.arange(steps + 1)*dt, np.zeros(steps + 1)
    deflections, speeds = np.zeros(steps + 1), np.full(steps + 1, float(speed))
    force = 0.0
    for i in range(1, steps + 1):
        free = c*q
        free += slow*v
        free += start*force
        v *= c
        v -= omega*s*q
        v += rate_start*force
        ball_free = ball + dt*speed - dt**2/3/model.mass*force
        patch_free = np.sum(free)
        new = contact.solve(ball_free - patch_free, compliance)
        q = free
        q += finish*new
        v += rate_finish*new
        deflections[i] = patch_free + (np.sum(finish) + static)*new
        ball = ball_free - dt**2/6/model.mass*new
        speed -= dt*(force + new)/2/model.mass
        force = new
        contact.commit(ball - deflections[i])
        forces[i], speeds[i] = force, speed
    return times, forces, speeds, deflections


if __name__ == '__main__':
    # Sun and Chen's case: 298.87 N at 39.9 us, contacts 0 to 220.2 and 344.0 to 415.0 us, -0.5178 m/s at 1000 us.
    case = Model((0.2, 0.2), [0, 90, 0, 90, 0, 0, 90, 0, 90, 0], 0.269e-3, (120e9, 7.9e9, 5.5e9, 5.5e9, 5.5e9, 0.3),
                 1580, 8.537e-3, 3, 6.35e-3, 8.112e8)
    for law in ('hertz', 'tan_sun'):
        t, f, u, _ = response(dataclasses.replace(case, law=law), 5e-3, 1e-3)
        begun = [round(1e6*t[i], 1) for i in range(1, len(t)) if (f[i] > 0) != (f[i - 1] > 0)]
        print(f'{law}: {f.max():.2f} N at {1e6*t[f.argmax()]:.1f} us, touch and release at {begun} us, {u[-1]:.4f} m/s')
