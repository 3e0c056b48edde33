"""Reads an exported run by the names of docs/hdf5.md; says what it found in one line of JSON."""

import json
import sys

import h5py
import numpy as np

NAMES = """recipe/layout_toml recipe/overrides kinds/numbers kinds/names bricks/foot bricks/heading bricks/kind bricks/color bricks/stance
tracks/brick tracks/start tracks/hinged_knots tracks/free_knots tracks/hinged tracks/free events/time events/kind events/brick events/by
events/force events/impulse events/point energy/time energy/kinetic energy/potential energy/push_work hashes/value""".split()


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def main(path):
    with h5py.File(path, "r") as run:
        found = []
        run.visititems(lambda name, item: found.append(name) if isinstance(item, h5py.Dataset) else None)
        assert sorted(found) == sorted(NAMES), sorted(set(found) ^ set(NAMES))
        for name in NAMES:
            assert "meaning" in run[name].attrs, name
        assert text(run["tracks/start"].attrs["unit"]) == "s"
        assert text(run["events/force"].attrs["unit"]) == "N"
        tracks = run["tracks/brick"].shape[0]
        first, count = run["tracks/hinged_knots"][tracks - 1]
        assert first + count == run["tracks/hinged"].shape[0]
        knots = run["tracks/hinged"][first : first + count]
        assert np.all(np.diff(knots[:, 0]) >= 0)
        print(
            json.dumps(
                {
                    "format": text(run.attrs["format"]),
                    "model": text(run["recipe"].attrs["model"]),
                    "layout": bytes(run["recipe/layout_toml"][:]).decode(),
                    "reason": text(run["end"].attrs["reason"]),
                    "bricks": run["bricks/foot"].shape[0],
                    "foot": run["bricks/foot"][2].tolist(),
                    "tracks": tracks,
                    "last_angle": float(knots[-1, 1]),
                    "force": round(float(run["events/force"][0]), 4),
                    "no_force": bool(np.isnan(run["events/force"][1])),
                    "by": run["events/by"][:].tolist(),
                    "samples": run["energy/time"].shape[0],
                    "stride": int(run["hashes"].attrs["stride"]),
                },
                sort_keys=True,
            )
        )


main(sys.argv[1])
