"""MP4 encoder: H.264 video by the ffmpeg that imageio-ffmpeg contains."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from PIL import Image

from stylobate.errors import FileError, ParameterError, UnsupportedError

# x264's quality (lower is finer), and duration of the last frame [s].
_FACTOR, _HOLD = "20", 1.5


def write_mp4(path: Path, pictures: Iterable[Image.Image], size: tuple[int, int], frames_per_second: float) -> None:
    """Write frames of one `size` [pixels] as H.264 video to `path`.

    Raises
    ------
    UnsupportedError
        If imageio-ffmpeg is not installed, or has no ffmpeg for this machine.
    ParameterError
        If width or height is odd, which H.264 does not support.
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
    """Return the function that writes frames to ffmpeg."""
    try:
        import imageio_ffmpeg

        imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        message = "an MP4 needs ffmpeg, which is not installed: pip install 'stylobate[video]', or write a .gif"
        raise UnsupportedError(message) from None
    return imageio_ffmpeg.write_frames
