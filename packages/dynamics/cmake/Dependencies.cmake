coplane_dependencies(PACKAGES element contact mesh material joint checkpoint core)
