// The C++ side of check_codec.mjs.
//   frame_dump encode         one JSON line per frame: every known message, several fillings
//   frame_dump decode         reads frames in hex from stdin, one a line; one JSON line each, or "null"
#include <iostream>
#include <string>

#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/parser.hpp"
#include "flight/mavlink/signing.hpp"
#include "hal/random.hpp"
#include "tests/flight/mavlink/message_json.hpp"

namespace {

using namespace forager::flight::mavlink;
using forager::hal::Random;

template <class T>
void fill(T& value, Random& random) {
  if constexpr (std::is_floating_point_v<T>)
    value =
        random.chance(0.06) ? std::numeric_limits<T>::quiet_NaN() : static_cast<T>(random.uniform(-1e4, 1e4));
  else
    value = static_cast<T>(random.next());
}
template <std::size_t kSize>
void fill(std::array<char, kSize>& text, Random& random) {
  const std::size_t length = random.below(kSize + 1);
  for (std::size_t i = 0; i < length; ++i) text[i] = static_cast<char>('A' + random.below(26));
}
template <class T, std::size_t kSize>
void fill(std::array<T, kSize>& values, Random& random) {
  for (T& value : values) fill(value, random);
}

// full: every field set; sparse: about half are zero, so that payloads get trimmed at all places.
template <Message M>
M make(const std::string& filling, Random& random) {
  M message;
  for_each_field(message, [&](const FieldLayout&, auto& value) {
    if (filling == "full" || (filling == "sparse" && random.chance(0.5))) fill(value, random);
  });
  return message;
}

template <Message M>
void dump(const std::string& filling, Random& random) {
  const M message = make<M>(filling, random);
  const auto sequence = static_cast<std::uint8_t>(random.next());
  const std::uint64_t timestamp = 30'000'000'000 + random.below(1'000'000'000);
  Sender sender{42, 191, sequence};
  FrameBuffer buffer;
  nlohmann::json line{{"name", M::kName},
                      {"id", M::kId},
                      {"filling", filling},
                      {"sysid", 42},
                      {"compid", 191},
                      {"seq", sequence},
                      {"crc_extra", kLayout<M>.crc_extra},
                      {"base_length", kLayout<M>.base_length},
                      {"full_length", kLayout<M>.full_length},
                      {"values", test::message_to_json(message)}};
  line["v2"] = test::to_hex(encode(message, sender, buffer));
  if constexpr (M::kId <= 0xFF) {
    sender.next_sequence = sequence;
    line["v1"] = test::to_hex(encode_v1(message, sender, buffer));
  }
  SigningKey key{};
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = std::byte(3 * i + 1);
  if (auto signing = Signing::create(key, 5, timestamp - 1, {})) {
    sender.next_sequence = sequence;
    encode(message, sender, buffer, kIncompatSigned);
    if (signing->sign(buffer, {})) line["v2_signed"] = test::to_hex(buffer.bytes());
    line["key"] = test::to_hex(key);
  }
  std::cout << line.dump() << '\n';
}

int encode_all() {
  Random random(20260822);
  for_each_message([&](const auto& type) {
    using M = std::decay_t<decltype(type)>;
    dump<M>("zero", random);
    for (int i = 0; i < 4; ++i) dump<M>("full", random);
    for (int i = 0; i < 8; ++i) dump<M>("sparse", random);
  });
  return 0;
}

int decode_lines() {
  for (std::string hex; std::getline(std::cin, hex);) {
    Parser parser;
    nlohmann::json line;
    parser.feed(test::from_hex(hex), [&](const Frame& frame) {
      for_each_message([&](const auto& type) {
        using M = std::decay_t<decltype(type)>;
        if (frame.id == M::kId)
          line = {{"name", M::kName},
                  {"seq", frame.sequence},
                  {"values", test::message_to_json(decode<M>(frame))}};
      });
    });
    std::cout << line.dump() << '\n';
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc == 2 ? argv[1] : "";
  if (mode == "encode") return encode_all();
  if (mode == "decode") return decode_lines();
  std::cerr << "usage: frame_dump encode | decode\n";
  return 2;
}
