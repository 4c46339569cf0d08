//! Particles in Debian's LIGGGHTS, run as a library by the host `calcine-liggghts`.
