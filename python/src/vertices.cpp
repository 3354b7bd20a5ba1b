#include "vertices.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>

#include <cstring>

#include "numbers.h"
#include "printing.h"

namespace odis::python {

namespace {

enum class Elements { floats, vectors, whole32, whole16, flags };

// A field of OdisPathVertices and its name in Python.
struct Field {
  const char* name;
  OdisVertexField OdisPathVertices::*described;
  Elements elements;
  bool required = false;
};

using V = OdisPathVertices;
constexpr Field kFields[] = {
    {"position", &V::position, Elements::vectors, true},
    {"normal", &V::normal, Elements::vectors, true},
    {"wo", &V::wo, Elements::vectors},
    {"wi", &V::wi, Elements::vectors, true},
    {"radiance", &V::radiance, Elements::vectors, true},
    {"weight", &V::weight, Elements::vectors},
    {"direct", &V::direct, Elements::vectors},
    {"pdf", &V::pdf, Elements::floats, true},
    {"survival", &V::survival, Elements::floats},
    {"guidable_pdf", &V::guidablePdf, Elements::floats},
    {"guidable_probability", &V::guidableProbability, Elements::floats},
    {"distance", &V::distance, Elements::floats},
    {"roughness", &V::roughness, Elements::floats},
    {"cosine", &V::cosine, Elements::floats},
    {"indirect", &V::indirect, Elements::floats},
    {"emission", &V::emission, Elements::floats},
    {"emission_light_pdf", &V::emissionLightPdf, Elements::floats},
    {"light", &V::light, Elements::floats},
    {"light_direction", &V::lightDirection, Elements::vectors},
    {"light_pdf", &V::lightPdf, Elements::floats},
    {"light_bsdf_pdf", &V::lightBsdfPdf, Elements::floats},
    {"light_guidable_pdf", &V::lightGuidablePdf, Elements::floats},
    {"rays_after", &V::raysAfter, Elements::floats},
    {"light_group_probability", &V::lightGroupProbability, Elements::floats},
    {"light_group", &V::lightGroup, Elements::whole32},
    {"lightable_groups", &V::lightableGroups, Elements::whole32},
    {"sample_weight", &V::sampleWeight, Elements::floats},
    {"time", &V::time, Elements::floats},
    {"pixel", &V::pixel, Elements::whole32},
    {"sample", &V::sample, Elements::whole32},
    {"depth", &V::depth, Elements::whole16, true},
    {"discrete", &V::discrete, Elements::flags},
    {"scatters_both_sides", &V::scattersBothSides, Elements::flags},
};

constexpr nb::dlpack::dtype kHalf{uint8_t(nb::dlpack::dtype_code::Float), 16, 1};

const Field& fieldNamed(const std::string& name) {
  for (const Field& field : kFields)
    if (name == field.name) return field;
  throw nb::value_error(("'" + name + "' is no field of a path vertex").c_str());
}

// The type that the elements of an array must have: half floats stay what they are where floats are expected.
nb::dlpack::dtype expectedType(Elements elements, const Array& array) {
  switch (elements) {
    case Elements::whole32:
      return nb::dtype<uint32_t>();
    case Elements::whole16:
      return nb::dtype<uint16_t>();
    case Elements::flags:
      return nb::dtype<bool>();
    default:
      return array.dtype() == kHalf ? kHalf : nb::dtype<float>();
  }
}

// Describes an array as a field of `count` vertices.
OdisVertexField describeField(const Field& field, const Array& array, size_t count) {
  const bool vectors = field.elements == Elements::vectors;
  requireArray(array, field.name, expectedType(field.elements, array), vectors ? 3 : 0, count);
  if (count == 0) return {};
  const int64_t bytes = int64_t(array.itemsize());
  if (vectors && array.stride(1) != 1)
    refuseArray(field.name, "rows of three numbers side by side",
                std::to_string(array.stride(1) * bytes) +
                    " bytes from one to the next (numpy.ascontiguousarray makes a copy that fits)");
  OdisVertexField result;
  result.data = array.data();
  result.format = array.dtype() == kHalf ? ODIS_FORMAT_HALF : ODIS_FORMAT_DEFAULT;
  if (count == 1) return result;
  const int64_t stride = array.stride(0) * bytes, least = vectors ? 3 * bytes : bytes;
  if (stride < least)
    refuseArray(
        field.name, "vertices one after another",
        "a stride of " + std::to_string(stride) + " bytes (numpy.ascontiguousarray makes a copy that fits)");
  result.stride = size_t(stride);
  return result;
}

// The number that is given for a field of all vertices, `count` times one after another.
template <class T>
std::vector<uint8_t> writtenOut(const Field& field, nb::handle given, const Array* array, size_t count) {
  T number{};
  if (array)
    number = numberIn<T>(*array, field.name);
  else if (std::is_same_v<T, bool> != PyBool_Check(given.ptr()) || !nb::try_cast(given, number))
    refuseArray(field.name, typeName(nb::dtype<T>()), nb::repr(given).c_str());
  std::vector<uint8_t> bytes(count * sizeof(T));
  for (size_t i = 0; i < count; ++i) std::memcpy(bytes.data() + i * sizeof(T), &number, sizeof(T));
  return bytes;
}

std::vector<uint8_t> writtenOut(const Field& field, nb::handle given, const Array* array, size_t count) {
  switch (field.elements) {
    case Elements::whole32:
      return writtenOut<uint32_t>(field, given, array, count);
    case Elements::whole16:
      return writtenOut<uint16_t>(field, given, array, count);
    case Elements::flags:
      return writtenOut<bool>(field, given, array, count);
    default:
      return writtenOut<float>(field, given, array, count);
  }
}

constexpr const char* kPathVertices = R"(Path vertices, described by arrays of their fields.

PathVertices(position=..., normal=..., ...) copies no array and keeps the arrays alive. An array is numpy's
or anything with DLPack or a buffer, of any length `count`, the same for all, and any positive stride. World
space, unit directions, densities with respect to solid angle, linear colours, radiance in the host's units.
A field of shape (count,) may be one number for all vertices: roughness=0.5, depth=1.

Of shape (count, 3), float32 or float16:
    position         required
    normal           required: shading normal, on the side of wo
    wo               towards the previous vertex
    wi               required: the sampled direction
    radiance         required: estimate of what arrives from wi, emission weighted by its MIS weight
    weight, direct   f |cos| / pdf / survival, and the next-event estimate of outgoing radiance; for roulette
    light_direction  towards the light that next-event estimation chose
Of shape (count,), float32 or float16, with the default:
    pdf                      required, > 0: density of wi
    survival                 in (0, 1] (1): with which roulette let the path go on
    guidable_pdf             the part of pdf that comes from lobes that may be guided (all)
    guidable_probability     in [0, 1]: how often the BSDF draws from such lobes (1)
    distance                 > 0: to the next vertex (infinity)
    roughness                in [0, 1]: alpha of the microfacet lobe that matters most (1: diffuse)
    cosine                   in [0, 1]: |cos| between wi and the normal (computed)
    indirect, emission, light             what the vertex adds to its pixel, as luminances (unknown): through
                                          wi, by emission that wi meets, by next-event estimation
    emission_light_pdf, light_pdf, light_bsdf_pdf, light_guidable_pdf     densities of that (0)
    rays_after               rays traced because of wi (unknown)
    light_group_probability  of choosing the group and tracing the shadow ray (0)
    sample_weight            of the path in its pixel (1)
    time                     (0)
Of shape (count,):
    depth                    required, uint16: 1 for the first vertex of a path
    pixel, sample            uint32: which vertex this is (0)
    light_group              uint32: that `direct` came from (NO_LIGHT_GROUP)
    lightable_groups         uint32: bit g is set where lights of group g may light the vertex (all)
    discrete                 bool: a delta lobe (False)
    scatters_both_sides      bool: the BSDF scatters to both sides of the surface (False)

Raises ValueError, naming the field, for another name, type, shape or length, and where a required field
lacks. Vertices whose numbers are not finite or out of their range are left out and counted when they are used
(VertexCounts).)";

}  // namespace

VertexArrays::VertexArrays(const nb::dict& fields) {
  if (!fields.contains("position")) throw nb::value_error("position: expected an array, found none");
  bool counted = false;
  const auto add = [&](const Field& field, nb::handle value) {
    Array array;
    const bool isArray = nb::try_cast(value, array), isVector = field.elements == Elements::vectors;
    const bool isNumber =
        isArray ? array.ndim() == 0 : PyFloat_Check(value.ptr()) || PyLong_Check(value.ptr());
    if (isNumber && !isVector) {
      const size_t count = m_described.count;
      m_writtenOut.push_back(std::make_shared<const std::vector<uint8_t>>(
          writtenOut(field, value, isArray ? &array : nullptr, count)));
      (m_described.*field.described).data = count > 0 ? m_writtenOut.back()->data() : nullptr;
      return;
    }
    if (!isArray)
      refuseArray(field.name, "an array with DLPack or a buffer, whose strides are multiples of its elements",
                  nb::repr(value.type()).c_str());
    if (!counted && array.ndim() > 0) m_described.count = array.shape(0);
    counted = true;
    m_described.*field.described = describeField(field, array, m_described.count);
    m_arrays.push_back(std::move(array));
  };
  // The number of vertices is that of positions.
  add(kFields[0], fields["position"]);
  for (const auto& [name, value] : fields) {
    const Field& field = fieldNamed(nb::str(name).c_str());
    if (&field != &kFields[0]) add(field, value);
  }
  for (const Field& field : kFields)
    if (field.required && m_described.count > 0 && !fields.contains(field.name))
      refuseArray(field.name, "an array", "none");
}

std::string VertexArrays::fieldNames() const {
  std::string names;
  for (const Field& field : kFields)
    if ((m_described.*field.described).data) names.append(names.empty() ? "" : ", ").append(field.name);
  return names;
}

VertexArrays vertexArrays(const VerticesArgument& vertices) {
  if (const nb::dict* fields = std::get_if<nb::dict>(&vertices)) return VertexArrays(*fields);
  return std::get<VertexArrays>(vertices);
}

void bindVertices(nb::module_& module) {
  nb::class_<VertexArrays>(module, "PathVertices", kPathVertices)
      .def("__init__",
           [](VertexArrays* self, const nb::kwargs& fields) { new (self) VertexArrays(nb::dict(fields)); })
      .def("__len__", [](const VertexArrays& self) { return self.described().count; })
      .def("__repr__", [](const VertexArrays& self) {
        return "<odis.PathVertices: " + std::to_string(self.described().count) +
               " vertices, fields: " + self.fieldNames() + ">";
      });

  nb::class_<VertexCounts> counts(module, "VertexCounts",
                                  "How many vertices were taken, and how many refused by reason.");
  counts.def_ro("accepted", &VertexCounts::accepted)
      .def_ro("discrete", &VertexCounts::discrete, "Delta lobes: there is nothing to learn from.")
      .def_ro("not_finite", &VertexCounts::notFinite, "Position, normal, wi, radiance, pdf or cosine.")
      .def_ro("no_density", &VertexCounts::noDensity, "pdf or survival not positive.")
      .def_ro("not_unit", &VertexCounts::notUnit, "normal or wi.")
      .def_ro("no_depth", &VertexCounts::noDepth, "Depth 0.")
      .def_ro("outside_frame", &VertexCounts::outsideFrame,
              "Pixel or sample that the pass did not ask for; counted by frames alone.")
      .def_ro("wrong_side", &VertexCounts::wrongSide, "normal on the other side than the wo that is given.")
      .def_ro("out_of_range", &VertexCounts::outOfRange, "A negative distance or density, say.")
      .def_ro("guidable_above_pdf", &VertexCounts::guidableAbovePdf,
              "guidable_pdf above pdf in a pass that is not guided; counted by frames alone.")
      .def_ro("unknown_lights", &VertexCounts::unknownLights, "light_group beyond GuideOptions.light_groups.")
      .def_ro("twice", &VertexCounts::twice,
              "pixel, sample and depth of a vertex before; counted by frames alone.")
      .def_ro("in_media", &VertexCounts::inMedia,
              "Of those accepted: scattered in media (a normal of zero).");
  printAttributes(
      counts, {"accepted", "discrete", "not_finite", "no_density", "not_unit", "no_depth", "outside_frame",
               "wrong_side", "out_of_range", "guidable_above_pdf", "unknown_lights", "twice", "in_media"});
}

}  // namespace odis::python
