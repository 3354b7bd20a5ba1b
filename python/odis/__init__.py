"""ODIS guides path tracing: from the first samples of an image it learns where light comes from, and says how to sample
the others, which leaves the image unbiased.

    builder = odis.GuideBuilder()
    vertices = odis.PathVertices(position=..., normal=..., wi=..., radiance=..., pdf=..., depth=...)
    builder.add(vertices)
    guide = builder.build()
    cells = guide.find_cells(positions, normals)
    directions, pdfs = guide.sample(cells, normals, uv)

`Frame` keeps a whole image; `odis.dataset` reads the data sets that ODIS' networks are trained on. The manual is
docs/python.md of the sources.
"""

from ._odis import (
    LEAST_CACHED_MAX_DEPTH,
    NO_CELL,
    NO_LIGHT_GROUP,
    UNLIMITED,
    Context,
    Error,
    ErrorCode,
    Frame,
    FrameOptions,
    FramePass,
    FrameStatistics,
    Guide,
    GuideBuilder,
    GuideOptions,
    Model,
    PassKind,
    PathVertices,
    Setting,
    SettingOwner,
    VertexCounts,
    read_setting,
    settings,
    version_text,
)

__version__ = version_text.split()[0]

__all__ = [
    "LEAST_CACHED_MAX_DEPTH",
    "NO_CELL",
    "NO_LIGHT_GROUP",
    "UNLIMITED",
    "Context",
    "Error",
    "ErrorCode",
    "Frame",
    "FrameOptions",
    "FramePass",
    "FrameStatistics",
    "Guide",
    "GuideBuilder",
    "GuideOptions",
    "Model",
    "PassKind",
    "PathVertices",
    "Setting",
    "SettingOwner",
    "VertexCounts",
    "read_setting",
    "settings",
    "version_text",
]
