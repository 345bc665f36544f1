"""Physics that join the cycle: heat, boundary contact, passes of a starved film."""
