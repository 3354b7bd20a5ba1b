# The network at pixels, where it is built.
odis_finds(test_odis odis_pixels)
