# The codec against node-mavlink, where `npm ci` was run in tests/node.
find_program(FORAGER_NODE node)
if(FORAGER_NODE AND EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/node/node_modules/node-mavlink")
  add_executable(frame_dump "${CMAKE_CURRENT_SOURCE_DIR}/node/frame_dump.cpp")
  target_include_directories(frame_dump PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(frame_dump PRIVATE forager_flight_mavlink forager_flags nlohmann_json::nlohmann_json)
  add_test(NAME mavlink_against_node
           COMMAND ${FORAGER_NODE} "${CMAKE_CURRENT_SOURCE_DIR}/node/check_codec.mjs" $<TARGET_FILE:frame_dump>)
  set_tests_properties(mavlink_against_node PROPERTIES TIMEOUT 60)
endif()
