#include "odis/api/options.h"

#include "odis/api/guard.h"
#include "odis/options/settings.h"

namespace odis::core {

namespace {

// Applies the settings of a struct of options; errors name it.
void applyGiven(FrameOptions& options, const char* settings, const std::string& owner) {
  if (!settings) return;
  try {
    applySettings(options, settings);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(owner + ".settings: " + error.what());
  }
}

void applyGuide(FrameOptions& options, const OdisGuideOptions& host) {
  const OdisGuideOptions given = adopt(host, "OdisGuideOptions");
  GuideOptions& guide = options.guide;
  guide.model = modelBehind(given.model);
  guide.lightGroups = given.lightGroups;
  if (given.lightPartCount > 0) requireArgument(given.lightParts, "OdisGuideOptions.lightParts");
  guide.lightParts.assign(given.lightParts, given.lightParts + given.lightPartCount);
  guide.progressFunction = given.progressFunction;
  guide.progressUser = given.progressUser;
  applyGiven(options, given.settings, "OdisGuideOptions");
}

}  // namespace

GuideOptions optionsOf(const OdisGuideOptions& given) {
  FrameOptions options;
  applyGuide(options, given);
  return options.guide;
}

FrameOptions optionsOf(const OdisFrameOptions& host) {
  const OdisFrameOptions given = adopt(host, "OdisFrameOptions");
  if (given.guide && given.builder)
    throw std::invalid_argument("OdisFrameOptions.guide: expected NULL, the builder has its own options");
  FrameOptions options;
  if (given.guide) applyGuide(options, *given.guide);
  options.width = given.width;
  options.height = given.height;
  options.samplesPerPixel = given.samplesPerPixel;
  options.mostSamplesPerPixel = given.mostSamplesPerPixel;
  options.seed = given.seed;
  options.keepPixelMeans = given.keepPixelMeans;
  options.tileOffsetX = given.tileOffsetX;
  options.tileOffsetY = given.tileOffsetY;
  applyGiven(options, given.settings, "OdisFrameOptions");
  return options;
}

}  // namespace odis::core

size_t odisGetSettingCount() {
  return odis::core::allSettings().size();
}

bool odisGetSetting(size_t index, OdisSetting* setting) {
  return odis::core::guarded(nullptr, false, [&] {
    odis::core::requireArgument(setting, "odisGetSetting: setting");
    const std::vector<OdisSetting>& all = odis::core::allSettings();
    if (index >= all.size())
      throw std::invalid_argument("odisGetSetting: index: expected less than " + std::to_string(all.size()));
    odis::core::fillIn(*setting, all[index], "OdisSetting");
    return true;
  });
}

const char* odisReadSetting(const char* settings, const char* name) {
  return odis::core::guarded(nullptr, static_cast<const char*>(nullptr), [&] {
    odis::core::requireArgument(name, "odisReadSetting: name");
    thread_local std::string value;
    value = odis::core::readSetting(settings ? settings : "", name);
    return value.c_str();
  });
}
