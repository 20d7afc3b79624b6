"""What a good run keeps: energies and momenta against what is in play."""

# Largest values that need no second look: of energies over the energy in play, of momenta over the largest momentum.
MOST = {"error": 0.01, "contact_remainder": 0.05, "hourglass": 0.05, "momentum_error": 1e-6}


def in_play(h):
    """The largest energy that was kinetic, internal, stored or came from outside [J], of arrays by column of the history."""
    return max(abs(h[name]).max() for name in ("kinetic", "internal", "external_work", "contact_stored", "initial")) or 1.0


def momentum_in_play(h):
    """The largest momentum [N s]."""
    return max(abs(h[f"momentum_{axis}"]).max() for axis in "xyz") or 1.0
