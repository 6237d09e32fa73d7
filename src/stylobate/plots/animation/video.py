"""Pictures as an MP4, written by the ffmpeg that imageio-ffmpeg brings along."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from PIL import Image

from stylobate.errors import FileError, ParameterError, UnsupportedError

# Of x264: what it may lose, lower being finer; and how long the last picture is shown [s].
_FACTOR, _HOLD = "20", 1.5


def write_mp4(path: Path, pictures: Iterable[Image.Image], size: tuple[int, int], frames_per_second: float) -> None:
    """Write pictures of one `size` [pixels] as H.264 video to `path`.

    Raises
    ------
    UnsupportedError
        If imageio-ffmpeg is not installed, or has no ffmpeg for this machine.
    ParameterError
        If width or height is odd, which this kind of video cannot have.
    FileError
        If the file cannot be written.
    """
    if size[0] % 2 or size[1] % 2:
        message = f"size must have even numbers for an MP4, got {size!r}"
        raise ParameterError(message)
    writer = _encoder()(
        str(path),
        size,
        fps=frames_per_second,
        codec="libx264",
        quality=None,
        macro_block_size=2,
        output_params=["-crf", _FACTOR, "-preset", "medium", "-movflags", "+faststart"],
        ffmpeg_log_level="error",
    )
    try:
        writer.send(None)
        last = b""
        for picture in pictures:
            last = picture.tobytes()
            writer.send(last)
        for _ in range(round(_HOLD * frames_per_second)):
            writer.send(last)
    except OSError as error:
        message = f"cannot write {path}: {str(error).strip().splitlines()[-1]}"
        raise FileError(message) from None
    finally:
        writer.close()


def _encoder() -> Any:
    """Return what writes frames to ffmpeg."""
    try:
        import imageio_ffmpeg  # noqa: PLC0415  an extra

        imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        message = "an MP4 needs ffmpeg, which is not installed: pip install 'stylobate[video]', or write a .gif"
        raise UnsupportedError(message) from None
    return imageio_ffmpeg.write_frames
