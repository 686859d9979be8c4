# The command `halfway`, for the CPU and for NVIDIA cards alike: Dr.Jit takes CUDA and OptiX from the card's driver.
#
#   docker build -t halfway .
#   docker run --rm -v "$PWD:/work" -u "$(id -u)" halfway route cherry-235 chrome -o route
#   docker run --rm --read-only --tmpfs /tmp -v "$PWD:/work" -u "$(id -u)" halfway check new.binary
#   docker run --rm --gpus all halfway doctor
#   docker run --rm --network host halfway view --no-browser
ARG BASE=debian:trixie-slim

FROM ${BASE} AS build
RUN apt-get update -qq && apt-get install -yqq --no-install-recommends python3-venv
WORKDIR /source
COPY . .
# Node for the explorer's page comes from PyPI.
RUN python3 -m venv /build && /build/bin/pip install --quiet build && /build/bin/python -m build --wheel --outdir /dist
RUN python3 -m venv /opt/halfway && /opt/halfway/bin/pip install --quiet --no-cache-dir /dist/*.whl
# karellen-llvm-core makes its links when Python first starts: here, where it may write.
RUN /opt/halfway/bin/halfway --version

FROM ${BASE}
RUN apt-get update -qq && apt-get install -yqq --no-install-recommends python3 libatomic1 && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/halfway /opt/halfway
ENV PATH=/opt/halfway/bin:$PATH NVIDIA_VISIBLE_DEVICES=all NVIDIA_DRIVER_CAPABILITIES=compute,graphics,utility
WORKDIR /work
USER 2000
ENTRYPOINT ["halfway"]
