"""The energy equation of the film (docs/theory/thermal.md): laws, shear, flow, columns, walls."""
