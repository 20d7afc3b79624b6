coplane_dependencies(PACKAGES element contact partition mesh material checkpoint core)
