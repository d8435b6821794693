# The real backends on a real kernel: built on demand and run in a guest by tests/kernel/run.sh, never by ctest.
if(FORAGER_HAVE_GPIOD)
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/kernel/*.cpp")
  add_executable(kernel_tests EXCLUDE_FROM_ALL ${sources})
  target_include_directories(kernel_tests PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(kernel_tests PRIVATE forager_tools forager_boards forager_mocks forager_hal_linux forager_servo
                        forager_flags forager_quick_compile forager_test_places fmt::fmt GTest::gmock Threads::Threads)
endif()
