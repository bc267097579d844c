// A search by CMA-ES as bytes, so that it can go on in another process with the same result to the last bit.
//
//   surefoot::write_file_atomically("search.cma", surefoot::save(result.search));
//   auto search = surefoot::load_cma_es_search(surefoot::read_file("search.cma"), "search.cma");
//   auto result = surefoot::cma_es(objective, search, options, executor);
//
// "SUREFCMA", u32 version, the fields in the order of transfer() in the .ipp, u64 checksum of all that; little-endian.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/cma_es_search.hpp"

namespace surefoot {

Bytes save(const CmaEsSearch& search);

/// `source` names the bytes in messages. Throws CoreError for anything but what save() wrote.
CmaEsSearch load_cma_es_search(std::span<const std::byte> bytes, const std::string& source);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/cma_es_serialize.ipp"
#endif
