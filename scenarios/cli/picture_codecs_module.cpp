#include "perception/io/picture_codecs.hpp"

/// The way into understory_picture_codecs.so, by a name that dlsym can find.
extern "C" const understory::PictureCodecs* understory_picture_codecs() {
  return &understory::picture_codecs();
}
