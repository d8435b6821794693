// Any bytes as a message body. What is accepted is well-formed to pugixml too and gives the same number of
// items; every read is within the limits that the rest of the program relies on; decoding into a used message
// gives what decoding into a fresh one gives; and no REST reply of any content does harm.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "reader/advannet_events.hpp"
#include "reader/advannet_rest.hpp"

namespace {

using forager::reader::AdvanNetMessage;
using forager::reader::TagRead;

void require(bool holds) {
  if (!holds) std::abort();
}

bool same(const AdvanNetMessage& a, const AdvanNetMessage& b) {
  if (a.kind != b.kind || a.reads.size() != b.reads.size() || a.inputs.size() != b.inputs.size() ||
      a.bad_items != b.bad_items || a.type != b.type || a.text != b.text)
    return false;
  for (std::size_t i = 0; i < a.reads.size(); ++i)
    if (a.reads[i].epc != b.reads[i].epc || a.reads[i].reader_ms != b.reads[i].reader_ms ||
        a.reads[i].rssi_dbm != b.reads[i].rssi_dbm || a.reads[i].port != b.reads[i].port)
      return false;
  return true;
}

void check_limits(const AdvanNetMessage& message) {
  for (const TagRead& read : message.reads) {
    require(!read.epc.empty() && read.epc.bytes().size() % 2 == 0);
    require(read.reader_ms > 0 && read.reader_ms <= 100'000'000'000'000);
    require(!read.phase_deg || std::isfinite(*read.phase_deg));
    require(read.read_count >= 1);
  }
  require(message.text.size() < 300 && message.type.size() < 300);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view body(reinterpret_cast<const char*>(data), size);
  static AdvanNetMessage used;
  AdvanNetMessage fresh;
  const bool accepted = decode_advannet_message(body, fresh).has_value();
  require(decode_advannet_message(body, used).has_value() == accepted);
  require(same(used, fresh));
  check_limits(fresh);
  if (accepted) {
    pugi::xml_document document;
    require(document.load_buffer(body.data(), body.size(), pugi::parse_cdata, pugi::encoding_utf8));
  } else {
    require(fresh.reads.empty() && fresh.inputs.empty());
  }
  const auto reply = forager::reader::advannet::parse_reply({200, std::string(body)});
  if (reply && reply->ok) require(reply->code.empty());
  return 0;
}
