#include "render/emitter/sun_position.h"

namespace odis::render {

namespace {

// Days from the civil date's midnight to noon of the first of January 2000, the epoch of the algorithm.
// Counts days in years that begin in March, so that the leap day is the last of its year.
double daysSinceEpoch(int year, int month, int day) {
  const int y = month > 2 ? year : year - 1;
  const int century = int(std::floor(y / 100.0));
  const int monthSinceMarch = (month + 9) % 12;
  const double days = std::floor(365.25 * y) - century + std::floor(century / 4.0) +
                      std::floor((153 * monthSinceMarch + 2) / 5.0) + day;
  constexpr double kFirstOfJanuary2000 = 730426;  // the same count for that day
  return days - kFirstOfJanuary2000 - 0.5;
}

}  // namespace

SunPosition sunPosition(const TimeAndPlace& when) {
  constexpr double kDegree = M_PI / 180;
  const double universalHour = when.hour - when.timezone + (when.minute + when.second / 60) / 60;
  const double days = daysSinceEpoch(when.year, when.month, when.day) + universalHour / 24;

  // Ecliptic coordinates of the sun.
  const double node = 2.1429 - 0.0010394594 * days;
  const double meanLongitude = 4.8950630 + 0.017202791698 * days;
  const double anomaly = 6.2400600 + 0.0172019699 * days;
  const double longitude = meanLongitude + 0.03341607 * std::sin(anomaly) +
                           0.00034894 * std::sin(2 * anomaly) - 0.0001134 - 0.0000203 * std::sin(node);
  const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(node);

  // Celestial coordinates, and the hour angle at the place.
  const double rightAscension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double siderealHours = 6.6974243242 + 0.0657098283 * days + universalHour;
  const double hourAngle = (siderealHours * 15 + when.longitude) * kDegree - rightAscension;

  // Local coordinates.
  const double latitude = when.latitude * kDegree;
  const double cosZenith = std::cos(latitude) * std::cos(hourAngle) * std::cos(declination) +
                           std::sin(declination) * std::sin(latitude);
  double zenith = std::acos(std::clamp(cosZenith, -1.0, 1.0));
  const double azimuth = std::atan2(-std::sin(hourAngle), std::tan(declination) * std::cos(latitude) -
                                                              std::sin(latitude) * std::cos(hourAngle));
  // The observer stands on the earth's surface, not at its centre.
  constexpr double kEarthRadius = 6371.01, kAstronomicalUnit = 149597890;  // km
  zenith += kEarthRadius / kAstronomicalUnit * std::sin(zenith);
  return {zenith, azimuth};
}

}  // namespace odis::render
