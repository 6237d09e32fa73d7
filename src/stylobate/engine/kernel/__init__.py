"""Integration of many runs at once: DOP853 over SIMD lanes, each lane with its own time, step and parameters."""
