"""Waves of the surfaces in results: found, fitted, compared with `tehl.estimate.wave_theory`."""

from tehl.post.waves.passing import PassingWave, passing_wave
from tehl.post.waves.response import WaveResponse, wave_notes, wave_responses

__all__ = ["PassingWave", "WaveResponse", "passing_wave", "wave_notes", "wave_responses"]
