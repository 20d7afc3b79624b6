"""Units and meanings of the variables of results; docs/user/outputs.md has them in full."""

VARIABLES = {
    "displacement": ("m", "displacement since the start"),
    "velocity": ("m/s", "velocity"),
    "contact_force": ("N", "contact force"),
    "contact_pressure": ("Pa", "mean normal traction of planes"),
    "contact_traction": ("Pa", "contact force over area of planes"),
    "contact_closure": ("m", "mean closure"),
    "contact_gap": ("m", "smallest gap; negative: overlap"),
    "contact_slip": ("m", "longest slip path"),
    "contact_state": ("1", "0 no plane, 1 open, 2 stick, 3 slip"),
    "stress": ("Pa", "stress, tension positive"),
    "von_mises": ("Pa", "von Mises stress"),
    "pressure": ("Pa", "pressure, compression positive"),
    "equivalent_plastic_strain": ("1", "equivalent plastic strain"),
    "density": ("kg/m^3", "current density"),
    "temperature": ("K", "temperature"),
    "alive": ("1", "1 alive, 0 eroded"),
    "time_step": ("s", "time step"),
    "eroded_mass": ("kg", "mass of eroded elements"),
    "side_state": ("1", "0 no plane, 1 open, 2 stick, 3 slip"),
    "side_area_fraction": ("1", "area that carries traction over area of the face"),
    "side_normal_traction": ("Pa", "mean normal traction, compression positive"),
    "side_shear_traction": ("Pa", "mean shear traction"),
    "side_closure": ("m", "mean closure"),
    "side_gap": ("m", "smallest gap; negative: overlap"),
    "side_slip": ("m", "longest slip path"),
}


def attributes(name):
    """`units` and `long_name` of a variable, as xarray wants them; of variables of laws only the name."""
    stem, _, last = name.rpartition("_")
    if stem in VARIABLES and 0 < len(last) < 3 and set(last) <= set("xyz"):
        unit, meaning = VARIABLES[stem]
        return {"units": unit, "long_name": f"{meaning}, {last}"}
    if name in VARIABLES:
        return dict(zip(("units", "long_name"), VARIABLES[name]))
    # Global variables besides time_step are energies.
    return {"long_name": name.replace("_", " ")}
