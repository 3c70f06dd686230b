#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "perception/io/calibration/calibration_file.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/euroc_text.hpp"
#include "tests/support/temporary_folder.hpp"

/// Whatever a calibration holds, reading it ends in a rig or in one line that says what was expected where.
namespace understory {
namespace {

using namespace support;
using CalibrationFaults = FolderTest;

const std::filesystem::path paper_xml = house_rigs / "raw/paper.xml";

CalibrationOptions centimetres() {
  CalibrationOptions options;
  options.meters_per_unit = 0.01;
  return options;
}

/// What the reader says of `path`; "" where it finds nothing wrong.
std::string complaint(const std::filesystem::path& path, const CalibrationOptions& options) {
  return refusal_of([&] { read_calibrated_rig(path, options); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

struct Fault {
  std::string from, to;
  std::string place;     ///< after the file's name
  std::string expected;  ///< somewhere in the line
};

const std::string m1 = "<M1 type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols><dt>d</dt>";
const std::string d1 = "<D1 type_id=\"opencv-matrix\"><rows>1</rows><cols>8</cols><dt>d</dt>";

TEST_F(CalibrationFaults, OpenCvXml) {
  const std::string good = content_of(paper_xml);
  const std::vector<Fault> faults{
      {"M1 type_id=\"opencv-matrix\"", "M1", ":6: M1: ", "must be an OpenCV matrix"},
      {"<M1", "<M3", ":11: ", "tags mismatch"},
      {m1, "<M1>", ":6: M1: ", "must be an OpenCV matrix"},
      {"<rows>3</rows><cols>3</cols>", "<rows>4</rows><cols>3</cols>",
       ":7: M1.data: ", "12 numbers, found 9"},
      {"<rows>3</rows><cols>3</cols>", "<rows>1</rows><cols>9</cols>", ":6: M1: ", "must have 3 x 3"},
      {"<rows>3</rows>", "<rows>99999</rows>", ":6: M1.rows: ", "from 0 to 16"},
      {"<rows>3</rows>", "<rows>-3</rows>", ":6: M1.rows: ", "found '-3'"},
      {"<rows>3</rows>", "<rows>2.5</rows>", ":6: M1.rows: ", "whole number"},
      {"<rows>3</rows>", "", ":6: M1.rows: ", "missing"},
      {"<dt>d</dt>", "<dt>u</dt>", ":6: M1.dt: ", "must be d or f"},
      {"1.9372085296386336e+02", ".Nan", ":8: M1.data: ", "found '.Nan'"},
      {"1.9372085296386336e+02", "inf", ":8: M1.data: ", "found 'inf'"},
      {"1.9372085296386336e+02", "1e999", ":8: M1.data: ", "must be a number"},
      {"1.9372085296386336e+02", "wide", ":8: M1.data: ", "found 'wide'"},
      {"1.9372085296386336e+02", "", ":7: M1.data: ", "9 numbers, found 8"},
      {"1.9372085296386336e+02 0.", "1.9372085296386336e+02 0.5", ":6: M1: ", "the form fx 0 cx"},
      {"1.9372085296386336e+02", "-193.", ":6: M1: ", "focal lengths must be from"},
      {"1.9498008610933283e+02", "1e6", ":6: M1: ", "principal point"},
      {d1, replaced(d1, "8", "7"), ":13: D1.data: ", "7 numbers, found 8"},
      {d1, replaced(replaced(d1, "1<", "2<"), "8", "4"), ":12: D1: ", "must be 4, 5 or 8 coefficients"},
      {"1.1664112259935457e+01", "1e7", ":12: D1: ", "coefficients must be within"},
      {"9.9972472944430446e-01", "0.9", ":17: R1: ", "must be a rotation"},
      {"1.0569958496093750e+02 -6.3686387251681153e+03", "1.0569958496093750e+02 0.",
       ": P2: ", "to the right"},
      {"-6.3686387251681153e+03", "-6e8", ": baseline in m: ", "another unit"},
      {"0. 1.8039546837176670e+02 1.0102472305297852e+02 0.", "0. 180.0 1.0102472305297852e+02 0.",
       ": P1, P2: ", "must be the same in both"},
      {"<image_width>376", "<image_width>1", ":4: image_width: ", "from 32 to 8192"},
      {"<image_width>376</image_width>", "", ": image_width: ", "missing"},
      {"<image_width>", "<image_height>240</image_height><image_width>",
       ":5: image_height: ", "this key is given twice"},
      {"P1 type_id", "P0 type_id", ":28: ", "tags mismatch"},
      {"<opencv_storage>", "<storage>", ":52: ", "tags mismatch"},
      {"</opencv_storage>", "</opencv_storage><more/>", ":52: ", "nothing may follow"},
      {"<?xml version=\"1.0\"?>", "<!DOCTYPE a [<!ENTITY b \"c\">]>", ":1: ", "not valid XML of OpenCV"},
  };
  for (const Fault& fault : faults) {
    const auto file = folder.write("rig.xml", replaced(good, fault.from, fault.to));
    expect_line(complaint(file, centimetres()), file.string() + fault.place, fault.expected);
  }
}

TEST_F(CalibrationFaults, OpenCvYaml) {
  const std::string good =
      "%YAML:1.0\n---\nM1: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 300., 0., 200., 0., "
      "300., 150., 0., 0., 1. ]\n"
      "M2: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 300., 0., 200., 0., 300., 150., 0., "
      "0., "
      "1. ]\n"
      "D1: !!opencv-matrix\n   rows: 0\n   cols: 0\n   dt: d\n   data: []\n"
      "D2: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: f\n   data: [ 0., 0., 0., 0., 0. ]\n"
      "R: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. "
      "]\n"
      "T: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n   data: [ -0.2, 0., 0. ]\n";
  CalibrationOptions options{1, 400, 300, std::nullopt};
  const auto file = folder.path() / "rig.yml";
  folder.write("rig.yml", good);
  EXPECT_EQ(complaint(file, options), "");
  expect_line(complaint(file, {}), file.string() + ": image size: ", "--size");
  options.width_px = 7;
  expect_line(complaint(file, options), file.string() + ": image size: ", "32 to 8192");
  options.width_px = 400;
  const std::vector<Fault> faults{
      {"M1: !!opencv-matrix", "M1:", ":3: M1: ", "must be an OpenCV matrix"},
      {"data: [ 300., 0., 200., 0., 300.", "data: [ .Nan, 0., 200., 0., 300.", ":7: M1.data: ", "'.Nan'"},
      {"rows: 1\n   cols: 5", "rows: 5\n   cols: 3", ":22: D2.data: ", "15 numbers, found 5"},
      {"[ -0.2, 0., 0. ]", "[ -0.2, 0., 0. ", ":", "expected a ]"},
      {"[ -0.2, 0., 0. ]", "[ 0.2, 0., 0. ]", ":28: T: ", "to the right"},
      {"[ -0.2, 0., 0. ]", "[ 0., -0.2, 0. ]", ":28: T: ", "to the right"},
      {"[ -0.2, 0., 0. ]", "[ 0., 0., 0. ]", ":28: T: ", "the right camera must lie to the right"},
      {"[ -0.2, 0., 0. ]", "[ -20., 0., 0. ]", ": baseline in m: ", "another unit"},
      {"T:", "t:", ": T: ", "missing"},
      {"M2:", "M1:", ":8: M1: ", "this key is given twice"},
      {"M2:", "? [a]\n:", ":8: ", "plain word"},
      {"D1: !!opencv-matrix", "D1: &again [*again]\nD3: !!opencv-matrix",
       ":13: ", "the value that contains it"},
      {"%YAML:1.0\n---\n", "%YAML:1.0\n---\na: 1\n---\n", ":4: ", "one YAML document"},
  };
  for (const Fault& fault : faults) {
    folder.write("rig.yml", replaced(good, fault.from, fault.to));
    expect_line(complaint(file, options), file.string() + fault.place, fault.expected);
  }
}

/// Numbers of a fisheye look like those of other lenses: the file says what they are, or might.
TEST_F(CalibrationFaults, KeysThatChangeWhatTheNumbersMean) {
  const std::string good = content_of(paper_xml);
  const auto with = [&](const std::string& key, const std::string& value) {
    folder.write("rig.xml", replaced(good, "</opencv_storage>",
                                     "<" + key + ">" + value + "</" + key + "></opencv_storage>"));
    return complaint(folder.path() / "rig.xml", centimetres());
  };
  for (const auto& [key, value] :
       {std::pair("fisheye_model", "yes"), std::pair("distortion_model", "division"),
        std::pair("camera_model", "omni"), std::pair("xi", "1.2")})
    EXPECT_NE(with(key, value).find(std::string(": ") + key + ": "), std::string::npos) << with(key, value);
  for (const auto& [key, value] :
       {std::pair("fisheye_model", "1"), std::pair("distortion_model", "equidistant"),
        std::pair("camera_model", "fisheye")})  // the file has 8 coefficients
    expect_part(with(key, value), "D1: must be the 4 coefficients of a fisheye lens");
  for (const auto& [key, value] : {std::pair("fisheye_model", "0"), std::pair("camera_model", "pinhole"),
                                   std::pair("distortion_model", "rational_polynomial"),
                                   std::pair("rms", "0.2"), std::pair("calibration_time", "today")})
    EXPECT_EQ(with(key, value), "") << key;
}

TEST_F(CalibrationFaults, Euroc) {
  const std::string good = euroc_sensor_text(euroc_left(), 300, 201);
  folder.write("cam1/sensor.yaml", euroc_sensor_text(euroc_right(), 302, 197));
  const std::vector<Fault> faults{
      {"T_BS:", "T_SB:", ":3: T_BS: ", "missing"},
      {"cols: 4", "cols: 3", ":6: T_BS.cols: ", "from 4 to 4"},
      {"data: [", "data: [1, ", ":8: T_BS.data: ", "16 numbers, found 17"},
      {"data: [", "data: [.inf, ", ":8: T_BS.data: ", "16 numbers"},
      {", 0, 0, 0, 1]", ", 0, 0, 1, 1]", ":5: T_BS: ", "last row"},
      {"-0.02", "200", ":5: T_BS: ", "at most 10 m"},
      {"[400, 300]", "[400]", ":10: resolution: ", "2 numbers, found 1"},
      {"[400, 300]", "[400, 0]", ":10: resolution: ", "from 32 to 8192"},
      {"[400, 300]", "[400.5, 300]", ":10: resolution: ", "whole numbers"},
      {"[400, 300]", "[400, 301]", "", "resolution: must be that of the left camera"},
      {"pinhole", "omni", ":11: camera_model: ", "expected pinhole, found 'omni'"},
      {"[300,", "[0,", ":12: intrinsics: ", "focal lengths must be from 10"},
      {"radial-tangential", "fov", ":13: distortion_model: ", "or equidistant, found 'fov'"},
      {"radial-tangential", "equidistant", "", "distortion_model: must be that of the left camera"},
      {", -0.0001]", "]", ":14: distortion_coefficients: ", "4 numbers, found 3"},
      {"%YAML:1.0", "a: [", ":", "expected a ]"},
  };
  const std::string left_file = (folder.path() / "cam0" / "sensor.yaml").string();
  for (const Fault& fault : faults) {
    folder.write("cam0/sensor.yaml", replaced(good, fault.from, fault.to));
    expect_line(complaint(folder.path(), {}), fault.place.empty() ? "" : left_file + fault.place,
                fault.expected);
  }
  folder.write("cam0/sensor.yaml", good);
  EXPECT_EQ(complaint(folder.path(), {}), "");
  expect_line(complaint(folder.path(), {1, 376, 240, 5.0}),
              folder.path().string() + ": image size: ", "400x300");
  std::filesystem::remove_all(folder.path() / "cam1");
  expect_line(complaint(folder.path(), {}), folder.path().string(), "cannot read this file");
}

TEST_F(CalibrationFaults, FilesAndFolders) {
  expect_line(complaint("/proc/nowhere", {}), "/proc/nowhere: ", "cannot read this file");
  expect_line(complaint(folder.path(), {}), folder.path().string() + ": holds no calibration",
              "M1.xml, D1.xml");
  expect_line(complaint("/dev/zero", {}), "/dev/zero: ", "this is a device");
  expect_line(complaint(folder.write("empty.xml", ""), {}), folder.path().string(),
              "must be one YAML document");
  folder.write("M1.xml", content_of(paper_xml));
  folder.write("M1.yml", "M1: 3\n");
  expect_line(complaint(folder.path(), {}), path("M1.yml") + ":1: M1: ", "this key is given twice");
  expect_line(complaint(paper_xml, {}), paper_xml.string() + ": baseline in m: ", "is 35.3038");
  expect_line(complaint(paper_xml, {0.01, {}, {}, 1e-3}),
              paper_xml.string() + ": detection depth: ", "0.1 to 1000");
  expect_line(complaint(paper_xml, {0.01, {}, {}, 500.0}),
              paper_xml.string() + ": detection depth: ", "infinity");
  expect_line(complaint(paper_xml, {0.01, 640, 480, {}}), paper_xml.string() + ": image size: ", "376x240");
  expect_line(complaint(paper_xml, {-1, {}, {}, {}}), paper_xml.string() + ": unit: ", "above 0");
}

/// Bytes on which a parser may go on for ever: found by fuzzing.
TEST_F(CalibrationFaults, StrayMarksEnd) {
  for (const char* text : {", w", ",a: [b", "} a", "]", "- a\n,", "a: 1\n, b", "a: b\n] c", ": : :"}) {
    const std::string found = complaint(folder.write("stray.yaml", text), {});
    expect_line(found, path("stray.yaml") + ":", "");
  }
}

/// Nesting that overflows the stack of cv::FileStorage.
TEST_F(CalibrationFaults, DeepNesting) {
  std::string xml = "<?xml version=\"1.0\"?><opencv_storage>", yaml = "%YAML:1.0\n---\nM1: ";
  for (int i = 0; i < 100'000; ++i) {
    xml += "<a>";
    yaml += "[";
  }
  for (int i = 0; i < 100'000; ++i) xml += "</a>";
  expect_line(complaint(folder.write("deep.xml", xml + "</opencv_storage>"), {}), folder.path().string(),
              "at most 16");
  expect_line(complaint(folder.write("deep.yml", yaml), {}), folder.path().string(), "expected a ]");
}

TEST_F(CalibrationFaults, TruncatedAnywhere) {
  const std::string good = content_of(paper_xml);
  for (std::size_t size = 0; size + 20 < good.size(); size += 13) {
    const std::string found = complaint(folder.write("cut.xml", good.substr(0, size)), centimetres());
    expect_line(found, path("cut.xml") + ":", "");
  }
}

TEST_F(CalibrationFaults, AnyBytesEndInARigOrInOneLine) {
  const std::string good = content_of(paper_xml);
  std::mt19937 random(1);
  for (int round = 0; round < 2000; ++round) {
    std::string text = good;
    for (int i = 0; i < 4; ++i) text[random() % text.size()] = static_cast<char>(random() % 256);
    const std::string found = complaint(folder.write("any.xml", text), centimetres());
    const bool is_one_line =
        std::none_of(found.begin(), found.end(), [](char c) { return c == '\n' || c == '\0'; });
    EXPECT_TRUE(is_one_line) << found;
    EXPECT_LT(found.size(), 1000u);
  }
}

}  // namespace
}  // namespace understory
