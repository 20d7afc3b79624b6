coplane_dependencies(PACKAGES element contact partition mesh geometry material checkpoint core)
