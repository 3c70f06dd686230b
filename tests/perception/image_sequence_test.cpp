#include "perception/io/image_sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/perception/rigs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using namespace support;
using ImageSequencePairs = FolderTest;

using Names = std::vector<std::string>;

TEST(ImageNames, NumbersSortByValue) {
  Names names{"b1", "a10", "a9", "a", "a09", "img_2_left", "img_10_left", "img_2"};
  std::sort(names.begin(), names.end(), [](const auto& a, const auto& b) { return comes_before(a, b); });
  EXPECT_EQ(names, (Names{"a", "a09", "a9", "a10", "b1", "img_2", "img_2_left", "img_10_left"}));
}

TEST(ImageNames, TimesAreToldByTheirForm) {
  EXPECT_EQ(time_in_name("1403715273262142976"), 1403715273262142976);
  EXPECT_EQ(time_in_name("1305031102.175304"), 1305031102175304000);
  EXPECT_EQ(time_in_name("0.5"), 500'000'000);
  for (const char* none :
       {"000001", "left", "img_1403715273262142976", "1.", ".5", "1.2.3", "99999999999999999999"})
    EXPECT_FALSE(time_in_name(none)) << none;
}

TEST(ImageNames, PairWhereNothingCanBeMissing) {
  EXPECT_FALSE(first_unpaired({"a", "b"}, {"a", "b"}));
  EXPECT_FALSE(first_unpaired({"left_1", "left_3"}, {"right_1", "right_3"}));
  EXPECT_FALSE(first_unpaired({"img0", "img1"}, {"img2", "img3"}));
  const auto lone = [](const Names& first, const Names& second) {
    const auto found = first_unpaired(first, second);
    return !found ? std::string("none") : (found->of_first ? first : second)[found->index];
  };
  EXPECT_EQ(lone({"1", "2", "3"}, {"1", "3"}), "2");
  // What differs within a folder pairs, not a size or a camera's number.
  EXPECT_EQ(lone({"img_0001_160x96", "img_0002_160x96"}, {"img_0001_160x96", "img_0003_160x96"}),
            "img_0002_160x96");
  EXPECT_EQ(lone({"f_1_cam0", "f_2_cam0"}, {"f_01_cam1", "f_02_cam1"}), "none");
  EXPECT_EQ(lone({"cam0_7", "cam0_8"}, {"cam1_7", "cam1_8"}), "none");
  EXPECT_EQ(lone({"f_1_cam0", "f_2_cam0", "f_3_cam0"}, {"f_1_cam1", "f_3_cam1"}), "f_2_cam0");
  EXPECT_EQ(lone({"1_9.763", "2_9.813", "3_9.863"}, {"1_9.764", "3_9.864"}),
            "2_9.813");  // clocks differ a little
  EXPECT_EQ(lone({"10.1", "10.6"}, {"10.2", "10.7"}), "10.1");
  EXPECT_EQ(lone({"1", "3"}, {"1", "2", "3"}), "2");
  EXPECT_EQ(lone({"1", "2", "3"}, {"1", "2"}), "3");
  EXPECT_EQ(lone({"1", "2"}, {"2", "3"}), "1");  // overlapping numbers: one is missing at either end
  EXPECT_EQ(lone({"1", "4"}, {"5", "6"}), "1");  // a gap
  EXPECT_EQ(lone({"ann", "bob"}, {"ann", "cat"}), "bob");
}

TEST_F(ImageSequencePairs, PairsFoldersInNumericalOrder) {
  for (const char* number : {"1", "2", "10"}) {
    folder.write(std::string("l/img_") + number + ".png", "");
    folder.write(std::string("r/img_") + number + ".PNG", "");
  }
  folder.write("l/notes.txt", "");
  folder.write("l/.hidden.png", "");
  const ImageSequence sequence = folder_sequence(folder.path() / "l", folder.path() / "r");
  ASSERT_EQ(sequence.pairs.size(), 3u);
  EXPECT_FALSE(sequence.timed);
  EXPECT_EQ(sequence.pairs[1].left, folder.path() / "l/img_2.png");
  EXPECT_EQ(sequence.pairs[2].right, folder.path() / "r/img_10.PNG");
  EXPECT_EQ(sequence.pairs[2].t_ns, 0);
}

TEST_F(ImageSequencePairs, TakesTimesFromNames) {
  for (const char* eye : {"l/", "r/"})
    for (const char* time : {"9.75", "10.25"}) folder.write(std::string(eye) + time + ".png", "");
  const ImageSequence sequence = folder_sequence(folder.path() / "l", folder.path() / "r");
  ASSERT_TRUE(sequence.timed);
  EXPECT_EQ(sequence.pairs[0].t_ns, 9'750'000'000);
  EXPECT_EQ(sequence.pairs[1].t_ns, 10'250'000'000);
  folder.write("l/9.8.png", "");
  folder.write("r/9.8.png", "");  // a time after 9.75, but a number before 75: order and times disagree
  expect_line(refusal_of([&] { folder_sequence(folder.path() / "l", folder.path() / "r"); }), "",
              "9.75.png: the times");
}

TEST_F(ImageSequencePairs, SaysWhichImageHasNoPartner) {
  folder.write("l/1.png", "");
  folder.write("l/2.png", "");
  folder.write("r/1.png", "");
  const auto pairing = [&] {
    return refusal_of([&] { folder_sequence(folder.path() / "l", folder.path() / "r"); });
  };
  EXPECT_EQ(pairing(), path("l/2.png") + ": has no partner in " + path("r") + " (2 left images, 1 right)");
  std::filesystem::create_directories(folder.path() / "empty");
  expect_line(refusal_of([&] { folder_sequence(folder.path() / "empty", folder.path() / "r"); }), "",
              "there are no images");
  expect_line(refusal_of([&] { folder_sequence(folder.path() / "none", folder.path() / "r"); }), "",
              "cannot read this folder");
  expect_line(refusal_of([&] { single_pair(folder.path() / "l/1.png", folder.path() / "r/2.png"); }), "",
              "r/2.png: expected");
}

struct Euroc : FolderTest {
  void write(const std::string& camera, const std::vector<std::string>& times) {
    std::string list = "#timestamp [ns],filename\r\n";
    for (const std::string& time : times) {
      list += time + "," + time + ".png\r\n";
      folder.write("mav0/" + camera + "/data/" + time + ".png", "");
    }
    folder.write("mav0/" + camera + "/data.csv", list);
  }
};

TEST_F(Euroc, PairsByTimeAndCountsTheRest) {
  write("cam0", {"100", "200", "300", "400"});
  write("cam1", {"100", "300", "350", "400"});
  for (const auto& place : {folder.path(), folder.path() / "mav0"}) {
    const ImageSequence sequence = euroc_sequence(place);
    ASSERT_EQ(sequence.pairs.size(), 3u);
    EXPECT_TRUE(sequence.timed);
    EXPECT_EQ(sequence.unpaired, 2);
    EXPECT_EQ(sequence.pairs[1].t_ns, 300);
    EXPECT_EQ(sequence.pairs[1].right, folder.path() / "mav0/cam1/data/300.png");
  }
}

TEST_F(Euroc, RefusesWhatIsMissing) {
  expect_line(refusal_of([&] { euroc_sequence(folder.path()); }), "", "not a EuRoC folder");
  write("cam0", {"100"});
  write("cam1", {"200"});
  expect_line(refusal_of([&] { euroc_sequence(folder.path()); }), "", "no time in common");
  write("cam1", {"100"});
  std::filesystem::remove(folder.path() / "mav0/cam1/data/100.png");
  expect_line(refusal_of([&] { euroc_sequence(folder.path()); }), "",
              "cam1/data/100.png: expected the image");
  std::filesystem::remove(folder.path() / "mav0/cam1/data.csv");
  expect_line(refusal_of([&] { euroc_sequence(folder.path()); }), "", "cam1/data.csv: cannot read this file");
}

TEST(EurocImages, ColumnsGoByTheirNames) {
  const auto turned = parse_euroc_images("#filename,timestamp [ns]\na.png,1\n", "d");
  EXPECT_EQ(turned.at(0).t_ns, 1);
  EXPECT_EQ(turned.at(0).file_name, "a.png");
  EXPECT_EQ(parse_euroc_images("\"timestamp\",\"filename\"\n1,\"a,b.png\"\n", "d").at(0).file_name,
            "a,b.png");
  for (const char* text : {"#timestamp [s],filename\n1,a.png\n", "#timestamp,picture of\n1,a.png\n"})
    EXPECT_EQ(refusal_of([&] { parse_euroc_images(text, "d"); }).find("d:1: "), 0u) << text;
}

TEST(EurocImages, NamesTheLineOfEveryFault) {
  const auto reading = [](const std::string& text) {
    return refusal_of([&] { parse_euroc_images(text, "d"); });
  };
  EXPECT_EQ(reading("1,a.png\n2,b.png"), "");
  for (const char* broken : {"2", "2,", "x,b.png", "2,b.png,c", "-2,b.png", "2,../b.png", "2.5,b.png"})
    EXPECT_EQ(reading("1,a.png\n" + std::string(broken)).find("d:2: expected 't,file name'"), 0u) << broken;
  EXPECT_EQ(reading("2,a.png\n2,b.png"), "d:2: times must increase from line to line");
  EXPECT_EQ(reading("#t,name\n"), "d: lists no image");
}

}  // namespace
}  // namespace understory
