"""How the figures of the pages are saved: twice as many pixels as a page shows, few colours, small files."""

from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

STATIC = Path(__file__).parents[1] / "_static"

# A page shows 735 pixels at most, 7.2 to 7.4 inches of a figure; screens have up to two pixels for each of them.
RESOLUTION = 200


def save(figure: Figure, path: Path) -> None:
    """Save a figure as PNG with 256 colours, which a drawing of lines does not exceed visibly."""
    buffer = BytesIO()
    figure.savefig(buffer, format="png", dpi=RESOLUTION)
    path.parent.mkdir(parents=True, exist_ok=True)
    picture = Image.open(buffer).convert("RGB").quantize(256, dither=Image.Dither.NONE)
    picture.save(path, optimize=True)
    print(path.relative_to(STATIC))
