// Pictures on their way to tev.
#include <gtest/gtest.h>

#include <cstring>

#include "command_runner.h"
#include "support/listener.h"
#include "viewer.h"

namespace odis::app {
namespace {

using render::Rgb;
using render::TevAddress;
using test::Listener;

// What a picture of one pixel ends with, as it is sent.
std::string lastPixel(const std::string& received) {
  return received.substr(received.size() - sizeof(Rgb));
}
std::string bytesOf(const Rgb& color) {
  std::string bytes(sizeof color, 0);
  std::memcpy(bytes.data(), &color, sizeof color);
  return bytes;
}

TEST(Viewer, SendsTheLastPictureBeforeItEnds) {
  Listener listener;
  listener.start();
  {
    Viewer viewer(TevAddress(listener.address()), "a");
    for (int i = 1; i <= 20; ++i) viewer.show(1, 1, {Rgb(float(i))});
  }
  EXPECT_EQ(lastPixel(listener.received()), bytesOf(Rgb(20)));
}

TEST(Viewer, WaitsLongerAndLonger) {
  Listener listener;
  listener.start();
  {
    Viewer viewer(TevAddress(listener.address()), "a");
    EXPECT_FALSE(viewer.isDue());
    std::this_thread::sleep_for(std::chrono::milliseconds(110));
    EXPECT_TRUE(viewer.isDue());
    viewer.show(1, 1, {Rgb(1)});
    EXPECT_FALSE(viewer.isDue());
  }
  listener.received();
}

TEST(Viewer, AsksForNothingWhereTevIsNot) {
  testing::internal::CaptureStderr();
  {
    Viewer viewer(TevAddress(test::closedAddress()), "a");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_FALSE(viewer.isDue());
    viewer.show(1, 1, {Rgb(1)});
  }
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("warning: cannot connect to tev at"), std::string::npos) << text;
}

using Command = test::Odis;

TEST_F(Command, ShowsTheImageThatItWrites) {
  Listener listener;
  listener.start();
  const test::Outcome outcome = run("render room.xml -q -o a.exr --tev " + listener.address());
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  const std::string& received = listener.received();
  EXPECT_NE(received.find("a.exr"), std::string::npos);
  EXPECT_GE(received.size(), 12 * 8 * sizeof(Rgb));
}

TEST_F(Command, WritesTheImageWhereTevIsNot) {
  const test::Outcome outcome = run("render room.xml -q -o a.exr --tev " + test::closedAddress());
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("is it running?"), std::string::npos) << outcome.text;
  EXPECT_TRUE(exists("a.exr"));
}

}  // namespace
}  // namespace odis::app
