coplane_dependencies(PACKAGES element contact partition mesh material joint checkpoint core)
