// The parts of a builder: what it gathered itself, and what was merged into it.
#include <algorithm>
#include <stdexcept>
#include <string>

#include "odis/guide_data.h"
#include "odis/options/settings.h"

namespace odis::core {

namespace {

void requireMergeable(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument("odisMergeGuideBuilders: " + message);
}

}  // namespace

CellStore& GuideBuilder::Data::allCells(std::optional<CellStore>& sum) {
  CellStore* only = &own().store;
  size_t count = 0;
  for (auto& [partId, part] : parts) {
    if (part.isEmpty()) continue;
    only = &part.store;
    ++count;
  }
  if (count <= 1) return *only;
  sum = newStore();
  sum->place(*grid());
  for (const auto& [partId, part] : parts) sum->add(part.store);
  return *sum;
}

const CellGrid* GuideBuilder::Data::grid() const {
  for (const auto& [partId, part] : parts)
    if (part.store.isPlaced()) return &part.store.grid();
  return nullptr;
}

void GuideBuilder::Data::requireSameOptions(const Data& other) const {
  const std::string differs = differingSetting(options, other.options);
  requireMergeable(differs.empty(), "the builders differ in " + differs);
  requireMergeable(options.lightGroups == other.options.lightGroups, "the builders differ in lightGroups");
  const auto same = [](const LightParts& a, const LightParts& b) {
    return a.first == b.first && a.count == b.count;
  };
  const std::vector<LightParts>&parts = options.lightParts, &others = other.options.lightParts;
  requireMergeable(std::equal(parts.begin(), parts.end(), others.begin(), others.end(), same),
                   "the builders differ in lightParts");
  requireMergeable(modelId == other.modelId, "the builders differ in model");
}

void GuideBuilder::setPartId(uint64_t id) {
  Data& d = *m_data;
  if (id == d.id) return;
  const auto found = d.parts.find(id);
  if (found != d.parts.end() && !found->second.isEmpty())
    throw std::invalid_argument("odisSetPartId: a part that was merged has the id " + std::to_string(id));
  d.parts.erase(id);
  auto own = d.parts.extract(d.id);
  own.key() = d.id = id;
  d.parts.insert(std::move(own));
}

size_t GuideBuilder::partCount() const {
  size_t count = 0;
  for (const auto& [id, part] : m_data->parts) count += !part.isEmpty();
  return count;
}

void GuideBuilder::merge(ArrayView<const GuideBuilder* const> others) {
  Data& d = *m_data;
  const CellGrid* grid = d.grid();
  std::map<uint64_t, BuilderPart> taken;
  for (const GuideBuilder* other : others) {
    d.requireSameOptions(*other->m_data);
    const CellGrid* given = other->m_data->grid();
    requireMergeable(!grid || !given || *given == *grid,
                     "the builders have cells of different extents; expected odisSetBounds with the same box "
                     "before the first vertices");
    if (!grid) grid = given;
    for (const auto& [id, part] : other->m_data->parts) {
      if (part.isEmpty()) continue;
      const auto known = d.parts.find(id);
      const bool isNew =
          (known == d.parts.end() || known->second.isEmpty()) && taken.emplace(id, part).second;
      requireMergeable(isNew,
                       "two parts have the id " + std::to_string(id) + "; expected each to have its own");
    }
  }
  for (const auto& [id, part] : taken) d.parts.erase(id);
  d.parts.merge(taken);
  d.parts.try_emplace(d.id, BuilderPart{d.newStore(), {}});
  for (auto& [id, part] : d.parts)
    if (grid && !part.store.isPlaced()) part.store.place(*grid);
}

}  // namespace odis::core
