// sun, sky, sunsky: daylight under a clear sky, by place and time or by the direction of the sun.
//
//   turbidity          number         haze, 1 (arctic) to 10; default 3
//   sun_direction      vector         towards the sun, in world space; not together with time or place
//   year, month, day   integers       default 2010, 7, 10
//   hour, minute, second   numbers    local time; default 15, 0, 0
//   latitude, longitude, timezone   numbers   degrees north, degrees east, hours ahead of universal time;
//                                     default 35.6894, 139.6917, 9: Tokyo
//   to_world           transform      turns sky and sun; default identity
//   albedo             rgb or number  of the ground, which brightens the sky; default 0.3
//   scale              number         multiplies sun and sky; default 1
//   sun_scale, sky_scale   numbers    of sunsky: each replaces scale for its part
//   sun_radius_scale   number         widens the sun without changing its power; default 1; 0 makes it a
//                                     directional light
//   stretch            number         1 to 2; pulls the sky below the horizon; default 1
//   resolution         integer        width of the table that the sky is sampled by; default 512
//   sun_aperture       number         of Mitsuba 3: the sun's apparent diameter in degrees, in place of
//                                     sun_radius_scale; default 0.5358
//
// Up is +Y, north -Z, east +X in Mitsuba 0.6; up +Z, north -X, east -Y in Mitsuba 3, which knows `sunsky`
// only. An element is of the latter if it has sun_aperture or complex_sun (true is drawn as false), and so is
// the sunsky of a scene of version 2 or later without a parameter that only Mitsuba 0.6 knows.
//
// Sun and sky are two lights, the sky exactly the model's, the sun a disc of constant radiance. Colours and
// units: daylight.h.
#include "render/emitter/daylight.h"
#include "render/emitter/directional.h"
#include "render/emitter/factories.h"
#include "render/emitter/sky_dome.h"
#include "render/emitter/sun_disc.h"
#include "render/emitter/sun_position.h"

namespace odis::render {

namespace {

constexpr float kDegree = kPi / 180;
constexpr float kSunDiameter = 0.5358f;  // degrees

// What sun and sky have in common.
struct Daylight {
  Matrix4 toWorld;      // from the sky's space, where up is +Y
  Vec3 sunDirection;    // in that space
  float sunZenith = 0;  // radians, before the stretch
  float turbidity = 3;
  float stretch = 1;
  Rgb albedo;
};

// The axes of Mitsuba 3's sky in those of ours.
const Matrix4 kZUp(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);

Vec3 directionFromTime(const Properties& node, bool zUp) {
  TimeAndPlace when;
  when.year = int(node.integer("year", between(1, 9999), when.year));
  when.month = int(node.integer("month", between(1, 12), when.month));
  when.day = int(node.integer("day", between(1, 31), when.day));
  when.hour = node.number("hour", between(0, 24), float(when.hour));
  when.minute = node.number("minute", between(0, 60), float(when.minute));
  when.second = node.number("second", between(0, 60), float(when.second));
  when.latitude = node.number("latitude", between(-90, 90), float(when.latitude));
  when.longitude = node.number("longitude", between(-360, 360), float(when.longitude));
  when.timezone = node.number("timezone", between(-24, 24), float(when.timezone));
  const SunPosition sun = sunPosition(when);
  const float north = float(std::sin(sun.zenith) * std::cos(sun.azimuth));
  const float east = float(std::sin(sun.zenith) * std::sin(sun.azimuth));
  const float up = float(std::cos(sun.zenith));
  if (zUp) return transformVector(kZUp.transposed(), Vec3(-north, -east, up));
  return {east, up, -north};
}

// Whether the element is one of Mitsuba 3.
bool hasUpAlongZ(const Properties& node) {
  const auto hasAny = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return node.has(name); });
  };
  if (hasAny({"sun_aperture", "complex_sun"})) return true;
  return node.type == "sunsky" && !node.before2 &&
         !hasAny({"extend", "resolution", "scale", "stretch", "sun_radius_scale"});
}

Daylight readDaylight(const Properties& node) {
  const bool zUp = hasUpAlongZ(node);
  Daylight result;
  result.toWorld = node.transform("to_world");
  if (zUp) result.toWorld = kZUp * result.toWorld;
  if (!std::isnormal(result.toWorld.minorOf(3, 3)))
    throw SceneError(node.location, "the to_world of \"" + node.type + "\" has no inverse");
  result.albedo = node.color("albedo", between(0, 1), Rgb(0.3f));
  result.turbidity = node.number("turbidity", between(1, 10), 3.0f);
  result.stretch = node.number("stretch", between(1, 2), 1.0f);

  for (const char* parameter : {"latitude", "longitude", "timezone", "year", "month", "day", "hour"})
    refuseBoth(node, "sun_direction", parameter);
  const Vec3 ofTime = directionFromTime(node, zUp), given = node.vector("sun_direction", ofTime);
  node.describeFallback("sun_direction", "by time and place");
  Vec3 toSun = node.has("sun_direction") ? transformVector(result.toWorld.inverse(), given) : ofTime;
  if (!isFinite(toSun) || !(length(toSun) > 0))
    throw SceneError(node.location, "the direction of the sun is not a finite vector other than zero");
  toSun = normalize(toSun);
  if (toSun.y < 0)
    throw SceneError(node.location, "the sun of \"" + node.type +
                                        "\" is below the horizon; expected daylight, with " +
                                        (zUp ? "+Z" : "+Y") + " of to_world as up");
  result.sunZenith = std::acos(std::min(toSun.y, 1.0f));
  result.sunDirection = toSun;
  return result;
}

EmitterPtr skyLight(const Properties& node, const Daylight& daylight, float scale) {
  const int64_t width = node.integer("resolution", between(4, 16384), 512);
  const Sky sky(daylight.turbidity, daylight.sunZenith, daylight.albedo);
  return std::make_shared<SkyDome>(sky, daylight.sunDirection, scale, daylight.stretch, int(width),
                                   daylight.toWorld);
}

EmitterPtr sunLight(const Properties& node, const Daylight& daylight, float scale) {
  refuseBoth(node, "sun_aperture", "sun_radius_scale");
  // At most the whole sphere.
  const float scaled = kSunDiameter * node.number("sun_radius_scale", between(0, 670), 1.0f);
  const float diameter = node.number("sun_aperture", between(0, 360), scaled);
  node.describeFallback("sun_aperture", "0.5358 sun_radius_scale");
  // The stretch moves the sun along with the sky about it.
  Vec3 local = daylight.sunDirection;
  const float horizontal = std::hypot(local.x, local.z), zenith = daylight.sunZenith * daylight.stretch;
  if (daylight.stretch != 1 && horizontal > 0)
    local = {local.x / horizontal * std::sin(zenith), std::cos(zenith),
             local.z / horizontal * std::sin(zenith)};
  const Vec3 direction = normalize(transformVector(daylight.toWorld, local));

  // A cap of the sphere has the solid angle pi times its squared chord; see SunDisc.
  const Rgb radiance = sunRadiance(daylight.turbidity, daylight.sunZenith) * scale;
  const float trueChord = 2 * std::sin(kSunDiameter / 4 * kDegree),
              chord = 2 * std::sin(diameter / 4 * kDegree);
  if (diameter == 0) return std::make_shared<DirectionalLight>(-direction, radiance * (kPi * sqr(trueChord)));
  return std::make_shared<SunDisc>(direction, diameter / 2 * kDegree, radiance * sqr(trueChord / chord));
}

void warnOfComplexSun(const Properties& node, Builder& builder) {
  if (node.boolean("complex_sun", false))
    builder.warn(node.location, "complex_sun is not supported; the sun is a disc of constant radiance");
}

}  // namespace

std::vector<EmitterPtr> makeSun(const Properties& node, Builder& builder) {
  warnOfComplexSun(node, builder);
  return {sunLight(node, readDaylight(node), emissionScale(node, "scale", 1.0f))};
}

std::vector<EmitterPtr> makeSky(const Properties& node, Builder&) {
  return {skyLight(node, readDaylight(node), emissionScale(node, "scale", 1.0f))};
}

std::vector<EmitterPtr> makeSunSky(const Properties& node, Builder& builder) {
  warnOfComplexSun(node, builder);
  const Daylight daylight = readDaylight(node);
  const float scale = emissionScale(node, "scale", 1.0f);
  const float skyScale = emissionScale(node, "sky_scale", scale),
              sunScale = emissionScale(node, "sun_scale", scale);
  node.describeFallback("sky_scale", "scale");
  node.describeFallback("sun_scale", "scale");
  std::vector<EmitterPtr> lights;
  if (skyScale > 0) lights.push_back(skyLight(node, daylight, skyScale));
  if (sunScale > 0) lights.push_back(sunLight(node, daylight, sunScale));
  return lights;
}

}  // namespace odis::render
