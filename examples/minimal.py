"""From vertices of paths to a sampled direction, in Python: every call that it takes. Vertices are made up here; a
renderer reports those of its own paths. Needs `pip install .`; docs/python.md has the rest.

    python3 examples/minimal.py
"""

import numpy as np

import odis

# 1. What the first, unguided paths saw. Each vertex is a place where a path was scattered: here 20,000 places on a floor
#    of one by one, under a small bright patch in the direction (0.6, 0, 0.8) and a dim sky.
count = 20000
random = np.random.default_rng(seed=1)
position = np.column_stack([random.random((count, 2)), np.zeros(count)]).astype(np.float32)
normal = np.tile(np.array([0, 0, 1], np.float32), (count, 1))
# The directions that the BSDF sampled: diffuse, so their density is cos / pi.
radius, phi = np.sqrt(random.random(count)), 2 * np.pi * random.random(count)
wi = np.column_stack([radius * np.cos(phi), radius * np.sin(phi), np.sqrt(1 - radius**2)]).astype(np.float32)
pdf = wi[:, 2] / np.float32(np.pi)
# The radiance that arrived from there: red, green, blue.
bright = np.array([0.6, 0, 0.8], np.float32)
radiance = np.where(wi @ bright > 0.97, 100, 0.1).astype(np.float32)[:, None].repeat(3, axis=1)
# Which vertex of its path it is: the first, counted from 1.
depth = np.ones(count, np.uint16)

# 2. Describes the arrays, which are neither copied nor changed. These six fields are required; help(odis.PathVertices)
#    lists all of them.
vertices = odis.PathVertices(position=position, normal=normal, wi=wi, pdf=pdf, radiance=radiance, depth=depth)

# 3. A builder sorts vertices into cells in world space. It may be given more of them as they arrive.
builder = odis.GuideBuilder()
builder.add(vertices)

# 4. The guide holds a map for each cell: a density over directions, of what arrives times the cosine.
guide = builder.build()
print(f"{len(guide)} cells from {builder.vertex_counts.accepted} vertices, {guide.bytes} bytes")

# 5. Where paths are to be guided now: at four points of the floor. Which cell is each of them in?
points = np.array([[0.2, 0.2, 0], [0.2, 0.8, 0], [0.8, 0.2, 0], [0.8, 0.8, 0]], np.float32)
normals = np.tile(np.array([0, 0, 1], np.float32), (4, 1))
cells = guide.find_cells(points, normals)

# 6. Samples a direction at each point from two uniform numbers. The densities are with respect to solid angle; where
#    there is no map they are 0.
directions, densities = guide.sample(cells, random.random((4, 2), np.float32))
for direction, density in zip(directions, densities):
    print(f"direction {direction}, density {density:.3f}, angle to the patch {np.degrees(np.arccos(direction @ bright)):.0f}°")

# 7. A renderer mixes that with its BSDF: with this probability a sample comes from the BSDF, else from the map. The
#    density of the mixture is what the sample's contribution is divided by, which leaves the image unbiased.
fraction = guide.bsdf_fraction(cells, roughness=np.ones(4, np.float32))
mixture = fraction * (directions[:, 2].clip(0) / np.pi) + (1 - fraction) * guide.pdf(cells, directions)
print("densities of the mixture", mixture)
