# Tests of the frame itself: real backends, the include rule, the installed package.
forager_tests(hal/linux LINKS forager_hal_linux forager_hal forager_mocks)
forager_tests(hal/linux/software_pwm LINKS forager_hal_linux forager_hal)  # what has a thread, by itself
if(NOT FORAGER_HAVE_CURL)
  forager_tests(hal/linux/absent LINKS forager_hal_linux)
elseif(FORAGER_HAVE_CRYPTO)
  forager_tests(hal/linux/http LINKS forager_hal_linux PkgConfig::CRYPTO)  # the test server hashes on its own
endif()

if(NOT FORAGER_HAVE_GPIOD)
  forager_tests(hal/linux/absent_gpiod LINKS forager_hal_linux)
else()  # under a fake kernel that speaks to both generations of libgpiod
  forager_tests(hal/linux/gpio LINKS forager_hal_linux ${CMAKE_DL_LIBS})
  forager_tests(boards/brakes LINKS forager_boards forager_mocks ${CMAKE_DL_LIBS})
endif()
# These define the functions of the library themselves, over emulated devices.
if(FORAGER_HAVE_LIBUSB)
  forager_tests(hal/linux/usb LINKS forager_hal_linux forager_mocks PkgConfig::LIBUSB)
else()
  forager_tests(hal/linux/absent_usb LINKS forager_hal_linux)
endif()
if(FORAGER_HAVE_HIDAPI)
  forager_tests(hal/linux/hid LINKS forager_hal_linux forager_mocks PkgConfig::HIDAPI)
else()
  forager_tests(hal/linux/absent_hid LINKS forager_hal_linux)
endif()
if(FORAGER_HAVE_MODBUS)
  forager_tests(hal/linux/modbus LINKS forager_hal_linux forager_mocks)
else()
  forager_tests(hal/linux/absent_modbus LINKS forager_hal_linux)
endif()

find_program(FORAGER_PYTHON NAMES python3 REQUIRED)
add_test(NAME include_rule
         COMMAND ${FORAGER_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/include_rule.py ${PROJECT_SOURCE_DIR})
add_test(NAME include_rule_catches_violations
         COMMAND ${FORAGER_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/include_rule.py --self-test)

if(TARGET forager AND NOT FORAGER_SANITIZE)  # a stranger's program is built without sanitizers
  add_test(NAME consumer COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/consumer/run.sh ${PROJECT_BINARY_DIR} ${CMAKE_CXX_COMPILER})
  set_tests_properties(consumer PROPERTIES TIMEOUT 300)
endif()
