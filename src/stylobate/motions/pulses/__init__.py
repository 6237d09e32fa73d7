"""Pulses: motions of the base along one line that begin and end."""

from stylobate.motions.pulses.gabor import Gabor
from stylobate.motions.pulses.mavroeidis_papageorgiou import MavroeidisPapageorgiou
from stylobate.motions.pulses.pulse import Pulse
from stylobate.motions.pulses.ricker import AntisymmetricRicker, Ricker
from stylobate.motions.pulses.sinusoid import Sinusoid
from stylobate.motions.pulses.waveform import Waveform

__all__ = ["AntisymmetricRicker", "Gabor", "MavroeidisPapageorgiou", "Pulse", "Ricker", "Sinusoid", "Waveform"]
