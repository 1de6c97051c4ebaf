"""Which topics of a recording belong to a joint: by name, by type and by what the messages say of themselves."""

from collections.abc import Callable, Mapping, Sequence

from ..contract import BLOCK_LABEL
from ..errors import listed
from ..sources import Quantity, Source
from .batches import RawTopic
from .errors import BagError


class TopicFinder:
    """Looks up topics as a node with remappings would, in a namespace that nobody needs to name.

    Parameters
    ----------
    topics : sequence of RawTopic
        The recording's.
    labels : callable
        Gives the labels of the dimensions of an array topic's first message.
    namespace : str, optional
        Namespace of the node whose inputs are wanted; needed only if several have been recorded.
    remap : mapping of str to str
        From the contract's relative names to the recording's.
    """

    def __init__(
        self,
        topics: Sequence[RawTopic],
        labels: Callable[[str], tuple[str, ...]],
        *,
        namespace: str | None = None,
        remap: Mapping[str, str] | None = None,
    ) -> None:
        self._topics = [topic for topic in topics if topic.messages]
        self._empty = [topic for topic in topics if not topic.messages]
        self._labels = labels
        self._namespace = namespace
        self._remap = {name.strip("/"): target for name, target in (remap or {}).items()}

    def joint_topics(self, sources: Mapping[Quantity, Source], joint: str | None = None) -> dict[Quantity, str]:
        """Find the topics of a joint.

        Parameters
        ----------
        sources : mapping of Quantity to Source
            The inputs that it needs.
        joint : str, optional
            Name below which its own topics stand; None if one joint is watched, whose topics stand alone.

        Raises
        ------
        BagError
            If a topic is not there, or more than one could be meant.
        """
        return {quantity: self._find(source, source.name_below(joint)) for quantity, source in sources.items()}

    def prefixes(self, source: Source) -> list[str]:
        """Namespaces, without the slashes around them, in which a source's topic stands."""
        suffix = f"/{source.topic}"
        return [t.name.removesuffix(suffix).strip("/") for t in self._of_type(source) if t.name.endswith(suffix)]

    def has(self, source: Source) -> bool:
        """Whether a source's topic stands in the recording by the contract's name, or by remapping."""
        return source.topic in self._remap or any(_ends(topic.name, source.topic) for topic in self._of_type(source))

    def _of_type(self, source: Source) -> list[RawTopic]:
        kind = source.type.replace("/", "/msg/")
        return [topic for topic in self._topics if topic.type == kind]

    def _find(self, source: Source, name: str) -> str:
        found = self._of_type(source)
        if name in self._remap or self._namespace is not None:
            target, namespace = self._remap.get(name, name), (self._namespace or "").strip("/")
            exact = target if target.startswith("/") else f"/{namespace}/{target}".replace("//", "/")
            if any(topic.name == exact for topic in found):
                return exact
            raise BagError(self._missing(source, exact))
        named = [topic.name for topic in found if _ends(topic.name, name)]
        if (plain := f"/{name.lstrip('/')}") in named:
            return plain
        if not named and "/" not in name.removesuffix(source.topic):
            # Under an unexpected name, an array says by its label that it is meant, other types by themselves.
            any_label = source.type != "std_msgs/Float64MultiArray"
            named = [topic.name for topic in found if any_label or BLOCK_LABEL in self._labels(topic.name)]
        if len(named) == 1:
            return named[0]
        if named:
            raise BagError(
                f"{listed(named)} could all be {name}; choose one with --namespace or --remap {name}:={named[0]}"
            )
        raise BagError(self._missing(source, name))

    def _missing(self, source: Source, name: str) -> str:
        """Say that a topic was not recorded, and what is there instead."""
        others = [topic for topic in self._topics if _ends(topic.name, name)]
        if others:
            instead = f"{listed([others[0].name])} is there, but as {_ros_type(others[0])}"
        elif any(_ends(topic.name, name) for topic in self._empty):
            instead = "the topic is there, but without a message"
        else:
            there = listed([f"{topic.name} ({_ros_type(topic)})" for topic in self._topics])
            instead = f"it holds {there}; see --remap and input.source"
        return f"no {name} ({source.type}) was recorded: {instead}"


def _ros_type(topic: RawTopic) -> str:
    return topic.type.replace("/msg/", "/")


def _ends(topic: str, name: str) -> bool:
    return topic.endswith("/" + name.lstrip("/"))
