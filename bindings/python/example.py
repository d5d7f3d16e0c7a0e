"""Example: what a BSSRDF file holds. `python3 example.py FILE.subsurf [PICTURE.png]`"""
from __future__ import annotations

import sys

import numpy as np

import subsurf


def main() -> None:
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    file = subsurf.load(sys.argv[1])
    print(file)
    for key, value in file.metadata().items():
        print(f"  {key}: {value!r}")
    if not isinstance(file, subsurf.Bssrdf):
        sys.exit("this example is for BSSRDF files")

    x, y = file.width // 2, file.height // 2
    print(f"albedo of pixel ({x}, {y}):", file.albedo(x, y).round(4))
    for distance in range(min(file.window_radius, 3) + 1):
        print(f"Rd from ({x + distance}, {y}) to ({x}, {y}):", file.rd(x + distance, y, x, y).round(5), "mm⁻²")

    radii = np.linspace(0, file.r_max, file.samples)
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        table(file, radii)
        return
    draw(file, radii, plt)
    if len(sys.argv) == 3:
        plt.savefig(sys.argv[2], dpi=120)
    else:
        plt.show()


def profiles(file: subsurf.Bssrdf) -> np.ndarray:
    """Up to eight profiles in mm⁻², [n, S, 3]: of base materials, or of pixels of the first row."""
    if len(file.bases):
        return np.exp(file.bases[:8])
    return np.exp(file.profile(np.arange(min(file.width, 8)), 0))


def mixture(file: subsurf.Bssrdf) -> np.ndarray:
    """Image of the pixels' reflectance at distance 0, [height, width, 3], from 0 to 1: what bases mix to."""
    image = np.exp(file.profile(*file.pixels())[..., 0, :])
    return (image / image.max()) ** (1 / 2.2)


def table(file: subsurf.Bssrdf, radii: np.ndarray) -> None:
    """Profiles as text, a line for each node."""
    print("r in mm, then red, green and blue of each profile in mm⁻²")
    for node, radius in enumerate(radii):
        print(f"{radius:8.4f}", *(f"{value:9.3g}" for value in profiles(file)[:, node].ravel()))


def draw(file: subsurf.Bssrdf, radii: np.ndarray, plt) -> None:
    """Picture of profiles, of the first base's share and of the mixture."""
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    for number, profile in enumerate(profiles(file)):
        for channel, colour in enumerate(("tab:red", "tab:green", "tab:blue")):
            axes[0].semilogy(radii, profile[:, channel], color=colour, alpha=0.4 + 0.6 / (number + 1))
    axes[0].set(title="Profiles of base materials" if len(file.bases) else "Profiles of pixels",
                xlabel="r in mm", ylabel="exp P̂ in mm⁻²")
    extent = (0, file.width * file.pitch, file.height * file.pitch, 0)
    share = file.ratios[0] if len(file.ratios) else np.ones((file.height, file.width))
    shown = axes[1].imshow(share, vmin=0, vmax=1, extent=extent)
    axes[1].set(title="Share of the first base", xlabel="mm")
    figure.colorbar(shown, ax=axes[1])
    axes[2].imshow(mixture(file), extent=extent)
    axes[2].set(title="Mixture: reflectance at r = 0", xlabel="mm")


if __name__ == "__main__":
    main()
