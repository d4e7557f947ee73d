# The Python that generates sources during the build: the checkout's .venv where there is one.

if(NOT DEFINED Python_EXECUTABLE AND NOT DEFINED SKBUILD AND EXISTS "${PROJECT_SOURCE_DIR}/.venv/bin/python")
    set(Python_EXECUTABLE "${PROJECT_SOURCE_DIR}/.venv/bin/python")
endif()

if(DECALGL_PYTHON)
    find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
else()
    find_package(Python 3.10 REQUIRED COMPONENTS Interpreter)
endif()

execute_process(COMMAND "${Python_EXECUTABLE}" -c "import glad" RESULT_VARIABLE glad_missing
                OUTPUT_QUIET ERROR_QUIET)
if(glad_missing)
    message(FATAL_ERROR "${Python_EXECUTABLE} has no glad2, which generates the table of OpenGL functions. "
                        "Run `make setup`, or install it: ${Python_EXECUTABLE} -m pip install glad2")
endif()
