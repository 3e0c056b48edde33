#!/usr/bin/env python3
"""The closed forms of one brick, computed apart from Topple: prints the numbers that source.toml holds.

h height, d thickness, phi = atan(d / h) the tip angle, psi = tilt - phi the angle from balance, R half the diagonal, k^2 = (h^2 + d^2) / 12.
  About a fixed toe:      (k^2 + R^2) w^2 / 2 + g R cos(psi) is constant.
  On a floor that slides: (k^2 + R^2 sin(psi)^2) w^2 / 2 + g R cos(psi) is constant (only the height of the centre of mass costs energy).
A time is the integral of 1 / w over the tilt.
"""
import math

G = 9.81


def brick(h=0.048, d=0.0075):
    return math.atan2(d, h), math.hypot(h, d) / 2, (h * h + d * d) / 12


def least_push(h, d):
    phi, radius, k2 = brick(h, d)
    return math.sqrt(2 * G * radius * (1 - math.cos(phi)) / (k2 + radius**2))


def time_to(tilt, w0, sliding=False, h=0.048, d=0.0075, steps=200000):
    """From standing, turning at w0, to a tilt [s]; Simpson's rule."""
    phi, radius, k2 = brick(h, d)

    def inertia(psi):
        return k2 + radius**2 * (math.sin(psi) ** 2 if sliding else 1)

    energy = inertia(-phi) * w0 * w0 / 2 + G * radius * math.cos(phi)

    def slowness(theta):
        psi = theta - phi
        return math.sqrt(inertia(psi) / (2 * (energy - G * radius * math.cos(psi))))

    width = tilt / steps
    total = slowness(0) + slowness(tilt)
    for i in range(1, steps):
        total += (4 if i % 2 else 2) * slowness(i * width)
    return total * width / 3


def after_blow(impulse, at, mass=0.0085, h=0.048, d=0.0075):
    """The turning of a standing brick on a floor that slides, after a horizontal blow at a height; the toe may not sink [rad/s]."""
    _, _, k2 = brick(h, d)
    return impulse * (at - h / 2) / (mass * (k2 + d * d / 4))


def main():
    print("least push [rad/s] for thickness / height:")
    for ratio in (0.05, 0.1, 0.15625, 0.2, 0.25, 0.3, 0.4, 0.5):
        print(f"  {ratio}: {least_push(0.048, 0.048 * ratio):.6f}")
    ten = math.radians(10)
    print("time to 10 degrees [ms], fixed toe:", [f"{w}: {1e3 * time_to(ten, w):.5f}" for w in (2.75, 3.0, 4.0, 6.0, 8.0)])
    print("time to the floor [ms], fixed toe:", [f"{w}: {1e3 * time_to(math.pi / 2, w):.5f}" for w in (2.75, 3.0, 4.0, 6.0, 8.0)])
    print("time to 10 degrees [ms], sliding:", [f"{w}: {1e3 * time_to(ten, w, True):.5f}" for w in (5.5, 6.0, 8.0)])
    print("time to the floor [ms], sliding:", [f"{w}: {1e3 * time_to(math.pi / 2, w, True):.5f}" for w in (5.5, 6.0, 8.0)])
    blow = after_blow(0.0005, 0.048)
    print(f"after a blow of 0.5 mN s at the top: {blow:.6f} rad/s; to 10 degrees {1e3 * time_to(ten, blow, True):.5f} ms,",
          f"to the floor {1e3 * time_to(math.pi / 2, blow, True):.5f} ms")
    print("tilt at the first hit [deg]:", [f"{s}: {math.degrees(math.asin(s / 48)):.6f}" for s in (7.5, 15, 22.5)])
    print("lean of the fallen [deg]:", [f"{s}: {math.degrees(math.acos(7.5 / (s + 7.5))):.6f}" for s in (7.5, 15, 22.5)])


if __name__ == "__main__":
    main()
