"""Pulses: base motions of finite duration along one line."""

from stylobate.base_motions.pulses.gabor import Gabor
from stylobate.base_motions.pulses.mavroeidis_papageorgiou import MavroeidisPapageorgiou
from stylobate.base_motions.pulses.pulse import Pulse
from stylobate.base_motions.pulses.ricker import AntisymmetricRicker, Ricker
from stylobate.base_motions.pulses.sinusoid import Sinusoid
from stylobate.base_motions.pulses.waveform import Waveform

__all__ = ["AntisymmetricRicker", "Gabor", "MavroeidisPapageorgiou", "Pulse", "Ricker", "Sinusoid", "Waveform"]
