# forager_library(<folder> [SOURCES ...] [LINKS ...] [PRIVATE_LINKS ...])
# One static library per folder, named forager_<folder> with '/' as '_', alias forager::<folder>.
# Without SOURCES it holds every .cpp directly in the folder.
set_property(GLOBAL PROPERTY FORAGER_LIBRARIES "")
function(forager_library folder)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  string(REPLACE "/" "_" name "${folder}")
  if(NOT arg_SOURCES)
    file(GLOB arg_SOURCES CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  endif()
  if(arg_SOURCES)
    add_library(forager_${name} STATIC ${arg_SOURCES})
    target_include_directories(forager_${name} PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/forager>)
    target_compile_features(forager_${name} PUBLIC cxx_std_20)
    target_link_libraries(forager_${name} PUBLIC ${arg_LINKS}
      PRIVATE $<BUILD_INTERFACE:forager_flags> $<BUILD_INTERFACE:forager_coverage>
      ${arg_PRIVATE_LINKS})
  else()
    add_library(forager_${name} INTERFACE)
    target_include_directories(forager_${name} INTERFACE
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/forager>)
    target_link_libraries(forager_${name} INTERFACE ${arg_LINKS})
  endif()
  set_target_properties(forager_${name} PROPERTIES EXPORT_NAME ${name})
  add_library(forager::${name} ALIAS forager_${name})
  set_property(GLOBAL APPEND PROPERTY FORAGER_LIBRARIES forager_${name})
endfunction()
