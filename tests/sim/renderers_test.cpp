#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <thread>

#include "sim/render/offscreen_backend.hpp"
#include "tests/sim/camera_scenes.hpp"
#include "tests/support/temporary_folder.hpp"

/// A process draws through one library: every renderer gets a child, and this process opens none.
namespace understory {
namespace {

namespace fs = std::filesystem;

void append(std::ofstream& file, const cv::Mat& image) {
  file.write(reinterpret_cast<const char*>(image.data),
             static_cast<std::streamsize>(image.total() * image.elemSize()));
}

/// The trees of forest_world(), grown.
World woods_world() {
  const World plain = forest_world();
  WorldConfig config{.scenery = Scenery::woods,
                     .woods = drawn({.kinds = WoodsKinds::mixed, .season = Season::summer}, 5)};
  const Wood wood = grow(plain.obstacles, config.woods, 5);
  return build_world(models_folder(), Airframe{}, wood.obstacles, config, wood.trees);
}

/// Pairs, depths, objects and chase views of several poses of a forest and of woods, one after the other.
/// Returns what drew them.
std::string draw(RendererKind renderer, const fs::path& to) {
  std::ofstream file(to, std::ios::binary);
  const World forest = forest_world(), woods = woods_world();
  StereoCameras bare(forest, paper_rig(), noiseless(), {1, 1}, std::nullopt, renderer);
  StereoCameras grown(woods, paper_rig(), noiseless(), {1, 1}, std::nullopt, renderer);
  for (int i = 0; i < 6; ++i) {
    StereoCameras& cameras = i < 4 ? bare : grown;
    const Eigen::Quaterniond attitude(Eigen::AngleAxisd(0.3 * i - 0.7, Eigen::Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(0.1 * i - 0.2, Eigen::Vector3d::UnitZ()));
    const Eigen::Isometry3d body = body_at({1.7 * i, 0.4 * i - 1, 3}, attitude);
    const StereoFrame frame = cameras.capture(body, i);
    append(file, frame.left);
    append(file, frame.right);
    append(file, cameras.depth(body));
    append(file, cameras.true_view(Eigen::Translation3d(1.7 * i, 0.4 * i - 1, 3) * attitude).objects);
    append(file, cameras.chase_view({.T_world_body = body}, 320, 200));
  }
  return bare.renderer();
}

struct Drawn {
  std::string pictures;  ///< empty where nothing could be drawn
  std::string complaint;
  std::string name;  ///< of the renderer
};

/// What draw() leaves in a process of its own, whose environment has these variables set.
Drawn drawn(RendererKind renderer, const std::map<std::string, std::string>& variables = {}) {
  const fs::path pictures = fs::path(testing::TempDir()) / ("renderers_" + std::to_string(getpid()));
  const fs::path complaint = pictures.string() + ".txt", drawn_by = pictures.string() + ".name";
  if (const pid_t child = fork(); child == 0) {
    for (const auto& [name, value] : variables) setenv(name.c_str(), value.c_str(), 1);
    try {
      std::ofstream(drawn_by) << draw(renderer, pictures);
    } catch (const std::runtime_error& error) {
      std::ofstream(complaint) << error.what();
    }
    _exit(0);
  } else {
    waitpid(child, nullptr, 0);
  }
  const Drawn result{support::content_of(pictures), support::content_of(complaint),
                     support::content_of(drawn_by)};
  for (const fs::path& file : {pictures, complaint, drawn_by}) fs::remove(file);
  return result;
}

TEST(Renderers, OsmesaAndEglDrawTheSameBitsInSoftware) {
  if (void* library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL)) {
    dlclose(library);
  } else {
    GTEST_SKIP() << "no libEGL.so.1 here (Debian's libegl1)";
  }
  if (has_gpu_device_file()) GTEST_SKIP() << "a GPU is here, and EGL draws on it";
  const Drawn osmesa = drawn(RendererKind::osmesa), egl = drawn(RendererKind::egl);
  EXPECT_EQ(osmesa.complaint + egl.complaint, "");
  EXPECT_EQ(osmesa.pictures.size(), 6u * (376 * 240 * (1 + 1 + 4 + 2) + 320 * 200 * 3));
  EXPECT_TRUE(osmesa.pictures == egl.pictures);
}

TEST(Renderers, AutomaticIsSoftwareWhereThereIsNoGpu) {
  if (has_gpu_device_file()) GTEST_SKIP() << "a GPU is here";
  const Drawn osmesa = drawn(RendererKind::osmesa), chosen = drawn(RendererKind::automatic);
  EXPECT_EQ(chosen.complaint, "");
  EXPECT_TRUE(osmesa.pictures == chosen.pictures);
}

TEST(Renderers, AMissingLibraryIsOneLineThatNamesThePackage) {
  const Drawn egl = drawn(RendererKind::egl, {{"UNDERSTORY_EGL", "/proc/nowhere/libEGL.so"}});
  EXPECT_NE(egl.complaint.find("libegl1"), std::string::npos) << egl.complaint;
  EXPECT_EQ(egl.complaint.find('\n'), std::string::npos);
  const Drawn none = drawn(RendererKind::egl, {{"UNDERSTORY_EGL", "libz.so.1"}});
  EXPECT_NE(none.complaint.find("no EGL"), std::string::npos) << none.complaint;
}

#ifdef UNDERSTORY_EGL_WITH_GPU
// No GPU's own driver can be tried in CI: a library that names one in its list of devices stands in.
TEST(Renderers, EglDrawsOnTheGpuThatTheDriverNames) {
  const Drawn osmesa = drawn(RendererKind::osmesa);
  const fs::path log = fs::path(testing::TempDir()) / ("egl_displays_" + std::to_string(getpid()));
  std::map<std::string, std::string> variables{{"UNDERSTORY_EGL", UNDERSTORY_EGL_WITH_GPU},
                                               {"EGL_WITH_GPU_LOG", log.string()}};
  const Drawn gpu = drawn(RendererKind::egl, variables);
  EXPECT_EQ(gpu.complaint, "");
  EXPECT_EQ(support::content_of(log), "gpu\n");
  EXPECT_TRUE(gpu.pictures == osmesa.pictures);  // a stand-in: real ones draw bits of their own
  fs::remove(log);

  variables["EGL_WITH_GPU_BROKEN"] = "1";
  const Drawn fallen_back = drawn(RendererKind::egl, variables);
  EXPECT_EQ(fallen_back.complaint, "");
  EXPECT_EQ(support::content_of(log), "gpu\nsurfaceless\n");
  EXPECT_TRUE(fallen_back.pictures == osmesa.pictures);
  fs::remove(log);
}

// MuJoCo takes a pbuffer for a window, and on NVIDIA's driver then fails: pictures are framebuffer objects,
// and a pbuffer is bound only where EGL asks for one. Two cameras are two contexts.
TEST(Renderers, APbufferIsMadeOnlyWhereAContextNeedsASurface) {
  const Drawn osmesa = drawn(RendererKind::osmesa);
  const fs::path log = fs::path(testing::TempDir()) / ("egl_surfaces_" + std::to_string(getpid()));
  const Drawn with = drawn(RendererKind::egl, {{"UNDERSTORY_EGL", UNDERSTORY_EGL_WITH_GPU},
                                               {"EGL_WITH_GPU_LOG", log.string()},
                                               {"EGL_WITH_GPU_NEEDS_SURFACE", "1"}});
  EXPECT_EQ(with.complaint, "");
  EXPECT_EQ(support::content_of(log), "gpu\npbuffer\npbuffer\n");
  EXPECT_TRUE(with.pictures == osmesa.pictures);
  fs::remove(log);
}

TEST(Renderers, AnErrorThatIsOlderThanMuJoCosContextIsClearedAndNamed) {
  const Drawn osmesa = drawn(RendererKind::osmesa);
  const Drawn stale =
      drawn(RendererKind::egl, {{"UNDERSTORY_EGL", UNDERSTORY_EGL_WITH_GPU}, {"EGL_WITH_GPU_ERROR", "1"}});
  EXPECT_EQ(stale.complaint, "");
  EXPECT_NE(stale.name.find(", began with OpenGL error 0x500"), std::string::npos) << stale.name;
  EXPECT_TRUE(stale.pictures == osmesa.pictures);
}
#endif

// The usual setting under WSL, Vulkan's, and none at all: Mesa ends the process, or draws other bits.
TEST(Renderers, TheEnvironmentDoesNotChooseTheDriver) {
  const Drawn osmesa = drawn(RendererKind::osmesa);
  for (const char* driver : {"d3d12", "zink", "softpipe", "nonsense"})
    for (const RendererKind kind : {RendererKind::osmesa, RendererKind::egl}) {
      if (kind == RendererKind::egl && has_gpu_device_file()) continue;
      const Drawn other = drawn(kind, {{"GALLIUM_DRIVER", driver}});
      EXPECT_EQ(other.complaint, "");
      EXPECT_TRUE(other.pictures == osmesa.pictures) << driver;
    }
}

TEST(Renderers, TheNameSaysWhichVariablesChangeBits) {
  const Drawn plain = drawn(RendererKind::osmesa);
  const Drawn changed =
      drawn(RendererKind::osmesa, {{"LP_PERF", "no_mip_linear"}, {"GLIBC_TUNABLES", "a.b=c"}});
  EXPECT_NE(plain.name.find("llvmpipe"), std::string::npos) << plain.name;
  EXPECT_EQ(changed.name, plain.name + ", GLIBC_TUNABLES=a.b=c, LP_PERF=no_mip_linear");
}

/// Runs in a process of its own, which ends with the number of failures.
int failures_in_child(const std::function<void()>& checks) {
  if (const pid_t child = fork(); child == 0) {
    checks();
    _exit(testing::Test::HasFailure() ? 1 : 0);
  } else {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
}

constexpr std::array both_renderers{RendererKind::osmesa, RendererKind::egl};

/// Of the ground below an empty forest, and of what stands 3 m straight ahead, by pencil.
void expect_closed_forms(RendererKind kind) {
  const StereoRig rig = paper_rig();
  const World empty = forest_world(false), trunks = forest_world(), woods = woods_world();
  StereoCameras above(empty, rig, noiseless(), {1, 1}, std::nullopt, kind);
  expect_depths_of_the_ground(above, rig);
  for (const World* world : {&trunks, &woods}) {
    StereoCameras before(*world, rig, noiseless(), {1, 1}, std::nullopt, kind);
    const TrueView view = before.true_view(body_at({5, 0, 1.3}, level));
    const int row = static_cast<int>(rig.center_y_px), column = static_cast<int>(rig.center_left_x_px);
    const int number = view.objects.at<std::uint16_t>(row, column) - object_first_obstacle;
    ASSERT_GE(number, 0);
    const double ahead_m = view.depth_m.at<float>(row, column);
    const Eigen::Vector3d place(5 + ahead_m, -(column - rig.center_left_x_px) / rig.focal_px * ahead_m,
                                1.3 - (row - rig.center_y_px) / rig.focal_px * ahead_m);
    double nearest_m = 1e9;
    for (std::size_t i = 0; i < world->obstacles.size(); ++i) {
      const Obstacle& piece = world->obstacles[i];
      // Woods number the trunk, the branches and the leaves of each tree.
      if (world == &trunks ? static_cast<int>(i) != number : piece.tree != number / 3) continue;
      const Eigen::Vector3d along = piece.to_world - piece.from_world;
      const double share = std::clamp((place - piece.from_world).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest_m =
          std::min(nearest_m, std::abs((place - piece.from_world - share * along).norm() - piece.radius_m));
    }
    EXPECT_LT(nearest_m, 0.01);
    EXPECT_EQ(number, world == &trunks ? 2 : 6);  // the trunk of the third tree, at x 8, y 0
  }
}

TEST(Renderers, DepthAndNumbersAgreeWithClosedForms) {
  for (const RendererKind kind : both_renderers)
    EXPECT_EQ(failures_in_child([&] { expect_closed_forms(kind); }), 0) << word_for(kind);
}

// A GPU rounds as it likes; what it draws is the same picture.
TEST(Renderers, AGpuDrawsNearlyWhatOsmesaDraws) {
  if (!has_gpu_device_file()) GTEST_SKIP() << "no GPU is here";
  const Drawn osmesa = drawn(RendererKind::osmesa), gpu = drawn(RendererKind::egl);
  ASSERT_EQ(gpu.complaint, "");
  ASSERT_EQ(gpu.pictures.size(), osmesa.pictures.size());
  constexpr std::size_t pair_px = std::size_t{2} * 376 * 240,
                        one = pair_px + 376 * 240 * (4 + 2) + 320 * 200 * 3;
  double sum = 0, far = 0;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t px = i * one; px < i * one + pair_px; ++px) {
      const int difference = std::abs(static_cast<std::uint8_t>(osmesa.pictures[px]) -
                                      static_cast<std::uint8_t>(gpu.pictures[px]));
      sum += difference, far += difference > 8;
    }
  std::printf("%s: %.2f gray levels from OSMesa's on average, %.1f %% of pixels by more than 8\n",
              gpu.name.c_str(), sum / (6 * pair_px), 100 * far / (6 * pair_px));
  EXPECT_LT(sum / (6 * pair_px), 1.5);
  EXPECT_LT(far / (6 * pair_px), 0.05);
  EXPECT_EQ(gpu.name.find("llvmpipe"), std::string::npos) << "a GPU is here, and software drew";
}

void expect_pictures_whatever_thread_ends_cameras(RendererKind kind) {
  const World world = forest_world();
  const auto cameras_now = [&] {
    return std::make_unique<StereoCameras>(world, paper_rig(), noiseless(), CameraSeeds{1, 1}, std::nullopt,
                                           kind);
  };
  const auto picture = [&](StereoCameras& cameras) {
    return cameras.capture(body_at({0, 0, 3}, level), 0).left.clone();
  };
  const cv::Mat expected = picture(*cameras_now());
  for (int i = 0; i < 3; ++i) {
    auto cameras = cameras_now();
    EXPECT_EQ(cv::norm(picture(*cameras), expected), 0);
    std::thread([&] { cameras.reset(); }).join();
  }
  for (int i = 0; i < 3; ++i) {  // made by a thread that has ended
    std::unique_ptr<StereoCameras> cameras;
    std::thread([&] {
      cameras = cameras_now();
      EXPECT_EQ(cv::norm(picture(*cameras), expected), 0);
    }).join();
    if (i > 0) cameras.reset();
    if (i == 0) std::thread([&] { cameras.reset(); }).join();
  }
  EXPECT_EQ(cv::norm(picture(*cameras_now()), expected), 0);
}

// What Python's garbage collector does: a context that is current on two threads ended the process.
TEST(Renderers, ACameraMayEndOnAnotherThread) {
  for (const RendererKind kind : both_renderers)
    EXPECT_EQ(failures_in_child([&] { expect_pictures_whatever_thread_ends_cameras(kind); }), 0)
        << word_for(kind);
}

TEST(Renderers, AProcessKeepsToItsFirstLibrary) {
  const World world = bare_world("");
  if (const pid_t child = fork(); child == 0) {
    const StereoCameras first(world, paper_rig(), noiseless(), {1, 1});
    const StereoCameras second(world, paper_rig(), noiseless(), {1, 1}, std::nullopt,
                               RendererKind::automatic);
    try {
      const StereoCameras other(world, paper_rig(), noiseless(), {1, 1}, std::nullopt, RendererKind::egl);
    } catch (const std::runtime_error&) {
      _exit(7);
    }
    _exit(0);
  } else {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 7);
  }
}

}  // namespace
}  // namespace understory
