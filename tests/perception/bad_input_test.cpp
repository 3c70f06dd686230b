#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <thread>

#include "perception/io/image_file.hpp"
#include "perception/io/pose_file.hpp"
#include "perception/io/text_file.hpp"
#include "perception/io/text_table.hpp"
#include "perception/io/text_tree.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/temporary_folder.hpp"

/// What a stranger may point a reader at ends in one line, soon, and in little memory.
namespace understory {
namespace {

using namespace support;
using BadInput = FolderTest;

std::string of_yaml(const std::string& text) {
  return refusal_of([&] { parse_yaml(text, "a.yaml"); });
}

long peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

TEST_F(BadInput, AliasesAreCopiesAndBounded) {
  const TextNode tree = parse_yaml("a: &one {b: [1, 2]}\nc: *one\n", "a.yaml");
  ASSERT_EQ(tree.children.size(), 2u);
  EXPECT_EQ(tree.children[1].key, "c");
  EXPECT_EQ(tree.children[1].origin, "a.yaml:2");
  EXPECT_EQ(tree.children[1].children[0].children[1].text, "2");

  std::string bomb = "- &a [x, x, x, x, x, x, x, x, x, x]\n";
  for (char name = 'b'; name < 'j'; ++name) {
    const std::string alias{'*', static_cast<char>(name - 1)};
    bomb += std::string("- &") + name + " [" + alias;
    for (int i = 1; i < 10; ++i) bomb += ", " + alias;
    bomb += "]\n";
  }
  const long before_mb = peak_mb();
  EXPECT_EQ(of_yaml("bomb:\n" + bomb), "a.yaml:6: a file may hold at most 100,000 values");
  EXPECT_LT(peak_mb() - before_mb, 200);

  expect_part(of_yaml("a: &a [*a]\n"), "a.yaml:1: an alias must not refer to the value that contains it");
  const std::string deep = "a: &a [[[[[[[x]]]]]]]\nb: &b [[[*a]]]\nc: &c [[[*b]]]\nd: &d [[[*c]]]\n";
  EXPECT_EQ(of_yaml(deep), "a.yaml:4: lists and maps may be nested at most 16 deep");
}

TEST_F(BadInput, ValuesAndLevelsAreBounded) {
  std::string many = "a: [";
  for (int i = 0; i < 100'000; ++i) many += "1,";
  EXPECT_EQ(of_yaml(many + "1]"), "a.yaml:1: a file may hold at most 100,000 values");
  EXPECT_EQ(of_yaml("a: [[[[[[[[[[[[[[[[[[[[x]]]]]]]]]]]]]]]]]]]]"),
            "a.yaml:1: lists and maps may be nested at most 16 deep");
  EXPECT_NE(of_yaml(std::string("a: ").append(500'000, '[')), "");
  std::string xml = "<opencv_storage>";
  for (int i = 0; i < 100'000; ++i) xml += "<a>1</a>";
  EXPECT_EQ(refusal_of([&] { parse_opencv_xml(xml + "</opencv_storage>", "a.xml"); }),
            "a.xml:1: a file may hold at most 100,000 values");
  EXPECT_EQ(refusal_of([] { table_lines(std::string(20'000'000, ','), CellsParted::by_commas, "a.csv"); }),
            "a.csv:1: a table must have at most 16 million cells");
}

TEST_F(BadInput, OnlyFilesOfModerateSizeAreRead) {
  const std::filesystem::path large = folder.write("large", "");
  std::filesystem::resize_file(large, std::uintmax_t{1} << 40);  // takes no room on the disk
  EXPECT_EQ(refusal_of([&] { read_file(large); }), large.string() + ": must be at most 1 MiB");
  EXPECT_EQ(refusal_of([&] { read_poses(large); }), large.string() + ": must be at most 256 MiB");
  EXPECT_EQ(refusal_of([&] { read_gray_image(large); }), large.string() + ": must be at most 256 MiB");
  const std::string found = ": cannot read this file";
  EXPECT_EQ(refusal_of([] { read_file("/dev/zero"); }), "/dev/zero" + found + ", this is a device");
  EXPECT_EQ(refusal_of([] { read_gray_image("/dev/zero"); }), "/dev/zero" + found + ", this is a device");
  EXPECT_EQ(refusal_of([&] { read_file(folder.path()); }),
            folder.path().string() + found + ", this is a folder");
  EXPECT_EQ(refusal_of([] { read_file("/proc/nowhere"); }),
            "/proc/nowhere" + found + ": No such file or directory");
  EXPECT_EQ(read_file(folder.write("exact", std::string(maximum_keyed_bytes, 'a'))).size(),
            maximum_keyed_bytes);
}

TEST_F(BadInput, APipeIsReadToItsEndAndNobodyIsWaitedFor) {
  const std::string pipe = path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(read_file(pipe), "");  // nobody writes
  const std::string text(200'000, 'a');
  // Reads nothing: it lets the writer open the pipe, and keep it open whoever comes first.
  const int idle_reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  std::ofstream stream(pipe);
  std::thread writer([&] {
    stream << text;
    stream.close();
  });
  EXPECT_EQ(read_file(pipe), text);
  writer.join();
  close(idle_reader);
}

/// Some bytes of header that ask for gigabytes.
TEST_F(BadInput, AnImagesHeaderIsBelievedNoFurtherThan8192Pixels) {
  using namespace std::string_literals;
  const std::string png = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\x01\0\0\0\x01\0\0\x08\0\0\0\0"s;
  const std::string bmp = "BM............\x28\0\0\0\0\0\x01\0\0\0\x01\0\x01\0\x08\0"s;
  const std::string jpeg = "\xFF\xD8\xFF\xE0\0\x04..\xFF\xC0\0\x0b\x08\xFF\xFF\xFF\xFF\x01\x01\x11\0"s;
  const std::string tiff =
      "II*\0\x08\0\0\0\x02\0\0\x01\x04\0\x01\0\0\0\0\0\x01\0\x01\x01\x04\0\x01\0\0\0\0\0\x01\0"s;
  for (const auto& [name, bytes] :
       {std::pair{"a.png", png}, {"a.bmp", bmp}, {"a.tif", tiff}, {"a.pgm", "P5 65536 65536 255\n"s}})
    expect_part(refusal_of([&] { read_gray_image(folder.write(name, bytes)); }), "found 65536x65536 px");
  expect_part(refusal_of([&] { read_gray_image(folder.write("a.jpg", jpeg)); }), "found 65535x65535 px");
}

}  // namespace
}  // namespace understory
