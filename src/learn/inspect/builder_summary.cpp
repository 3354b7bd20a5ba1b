#include <fmt/format.h>

#include "learn/inspect/summaries.h"
#include "odis/guide_data.h"
#include "odis/models/model.h"
#include "odis/options/settings.h"
#include "odis/record/vertex_fields.h"

namespace odis::learn {

void noteGuideOptions(std::vector<ChosenOption>& chosen, const core::GuideOptions& given) {
  noteOption(chosen, "lightGroups", given.lightGroups, core::GuideOptions().lightGroups);
  noteOption(chosen, "lightParts", given.lightParts.size(), size_t(0));
}

void noteSettings(std::vector<ChosenOption>& chosen, const std::string& settings) {
  for (const OdisSetting& setting : core::allSettings())
    noteOption(chosen, setting.name, core::readSetting(settings, setting.name),
               std::string(setting.defaultValue));
}

std::string modelText(uint64_t id) {
  if (id == 0) return "formulas";
  const auto part = [&](uint64_t network) { return (id & network) != 0 ? "a network" : "a formula"; };
  return fmt::format("directions by {}, lights by {}{}, weights {:08x}", part(core::kDirectionNetwork),
                     part(core::kLightNetwork),
                     (id & core::kPixelNetwork) != 0 ? ", pixels by a network" : "", uint32_t(id));
}

namespace {

PartSummary summarizePart(const core::Archive& file, const std::string& name, uint64_t id) {
  PartSummary part;
  part.id = id;
  for (const uint64_t key : file.get<uint64_t>(name + ".cells.keys")) {
    file.require(CellGrid::levelOf(key) < kCellLevels, name + ".cells.keys: are damaged");
    ++part.cells[size_t(CellGrid::levelOf(key))];
  }
  part.counts = core::loadFieldsOfOne<VertexCounts>(file, name + ".cells.counts");
  part.coarsening = file.valueOr<int32_t>(name + ".cells.coarsening", 1);
  part.samplesLeftOut = file.valueOr<uint64_t>(name + ".cells.leftOut", 0);
  part.unguided = file.value<uint64_t>(name + ".seen");
  return part;
}

}  // namespace

BuilderSummary summarizeBuilder(const core::Archive& file) {
  BuilderSummary result;
  const core::GuideOptions options = core::loadGuideOptions(file);
  noteGuideOptions(result.options, options);
  noteSettings(result.options, core::settingsText(options));
  result.model = modelText(file.value<uint64_t>("builder.model"));
  result.own = file.value<uint64_t>("builder.own");
  for (const uint64_t id : file.get<uint64_t>("builder.parts"))
    result.parts.push_back(summarizePart(file, fmt::format("part{}", result.parts.size()), id));
  return result;
}

}  // namespace odis::learn
