#include "hal/linux/curl_http_client.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <cerrno>
#include <utility>

#include "hal/linux/socket_error.hpp"

namespace forager::hal {

namespace {

constexpr std::size_t kMaxBody = std::size_t{16} << 20;

// Both handle types are void in libcurl's header, so one deleter cannot tell them apart.
struct EasyDeleter {
  void operator()(CURL* easy) const { curl_easy_cleanup(easy); }
};
struct MultiDeleter {
  void operator()(CURLM* multi) const { curl_multi_cleanup(multi); }
};
struct ListDeleter {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

bool curl_is_ready() {
  static const bool ready = curl_global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK;
  return ready;
}

size_t append_body(char* data, size_t, size_t size, void* user) {
  auto& body = *static_cast<std::string*>(user);
  if (body.size() + size > kMaxBody) return 0;  // libcurl then ends the transfer with CURLE_WRITE_ERROR
  body.append(data, size);
  return size;
}

class CurlHttpClient final : public HttpClient {
 public:
  CurlHttpClient(std::string base_url, std::optional<HttpCredentials> credentials)
      : base_url_(std::move(base_url)), credentials_(std::move(credentials)), name_("http " + base_url_) {
    while (base_url_.ends_with('/')) base_url_.pop_back();
    if (!curl_is_ready()) return;
    multi_.reset(curl_multi_init());
    easy_.reset(curl_easy_init());
    if (easy_) configure();
  }
  ~CurlHttpClient() override { end_transfer(); }
  CurlHttpClient(const CurlHttpClient&) = delete;
  CurlHttpClient& operator=(const CurlHttpClient&) = delete;

 private:
  void configure() {
    set(CURLOPT_NOSIGNAL, 1L);
    set(CURLOPT_PROXY, "");  // also overrules http_proxy in the environment
    set(CURLOPT_FOLLOWLOCATION, 0L);
    set(CURLOPT_PATH_AS_IS, 1L);
    set(CURLOPT_TCP_NODELAY, 1L);
    set(CURLOPT_USERAGENT, "forager");
    set(CURLOPT_WRITEFUNCTION, &append_body);
    set(CURLOPT_WRITEDATA, &body_);
    if (!credentials_) return;
    set(CURLOPT_USERNAME, credentials_->user.c_str());
    set(CURLOPT_PASSWORD, credentials_->password.c_str());
  }

  template <class T>
  void set(CURLoption option, T value) {
    // Fails only for options that the linked libcurl does not know or when memory ends; both show in the
    // transfer.
    (void)curl_easy_setopt(easy_.get(), option, value);
  }

  Result<> do_start(const HttpRequest& request, Instant now) override {
    operation_ = fmt::format("{} {}", request.method == HttpMethod::get ? "GET" : "PUT", request.path);
    if (in_flight_) return fail(ErrorCode::busy, name_, operation_, "a request is in flight");
    if (!easy_ || !multi_) return fail(ErrorCode::io, name_, operation_, "libcurl did not start");
    if (!base_url_.starts_with("http://") && !base_url_.starts_with("https://"))
      return fail(ErrorCode::invalid_argument, name_, operation_, "the address must start with http://");

    set(CURLOPT_URL, (base_url_ + request.path).c_str());
    set_method(request);
    FORAGER_TRY(begin_transfer());
    deadline_ = Deadline(now, request.timeout);
    timeout_ = request.timeout;
    return {};
  }

  Result<> begin_transfer() {
    body_.clear();
    if (credentials_) {
      // Without ONLY, libcurl would begin every series with an empty PUT to provoke the challenge, which a
      // reader without passwords would carry out.
      set(CURLOPT_HTTPAUTH,
          static_cast<long>(challenged_ ? CURLAUTH_DIGEST : CURLAUTH_DIGEST | CURLAUTH_ONLY));
    }
    if (curl_multi_add_handle(multi_.get(), easy_.get()) != CURLM_OK)
      return fail(ErrorCode::io, name_, operation_, "libcurl did not take the request");
    in_flight_ = true;
    int running = 0;
    (void)curl_multi_perform(multi_.get(), &running);  // begins to connect; the outcome shows in poll()
    return {};
  }

  void set_method(const HttpRequest& request) {
    headers_.reset();
    if (request.method == HttpMethod::get) {
      set(CURLOPT_CUSTOMREQUEST, static_cast<char*>(nullptr));
      set(CURLOPT_HTTPGET, 1L);
      set(CURLOPT_HTTPHEADER, static_cast<curl_slist*>(nullptr));
      return;
    }
    const std::string type =
        "Content-Type: " + (request.content_type.empty() ? std::string("text/plain") : request.content_type);
    headers_.reset(curl_slist_append(nullptr, type.c_str()));
    if (headers_) curl_slist_append(headers_.get(), "Expect:");  // the reader does not know 100-continue
    set(CURLOPT_HTTPHEADER, headers_.get());
    set(CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(request.body.size()));
    set(CURLOPT_COPYPOSTFIELDS, request.body.data());
    set(CURLOPT_CUSTOMREQUEST, "PUT");
  }

  Result<std::optional<HttpResponse>> do_poll(Instant now) override {
    if (!in_flight_) return fail(ErrorCode::invalid_state, name_, "poll", "no request is in flight");
    int running = 0;
    if (curl_multi_perform(multi_.get(), &running) != CURLM_OK) {
      end_transfer();
      return fail(ErrorCode::io, name_, operation_, "libcurl failed");
    }
    int queued = 0;
    while (const CURLMsg* message = curl_multi_info_read(multi_.get(), &queued)) {
      if (message->msg == CURLMSG_DONE) return conclude(message->data.result);
    }
    if (!deadline_.expired(now)) return std::optional<HttpResponse>();
    end_transfer();
    return fail(ErrorCode::timeout, name_, operation_,
                fmt::format("no complete answer within {:.3g} s", to_seconds(timeout_)),
                "Check power, cable and address of the device");
  }

  Result<std::optional<HttpResponse>> conclude(CURLcode code) {
    long status = 0;
    long schemes = 0;
    long os_error = 0;
    (void)curl_easy_getinfo(easy_.get(), CURLINFO_RESPONSE_CODE, &status);
    (void)curl_easy_getinfo(easy_.get(), CURLINFO_HTTPAUTH_AVAIL, &schemes);
    (void)curl_easy_getinfo(easy_.get(), CURLINFO_OS_ERRNO, &os_error);
    end_transfer();
    if (status == 401 && challenged_ && code == CURLE_OK) {
      // The server forgot the nonce (it restarted) without saying "stale". It has not carried the request
      // out.
      challenged_ = false;
      FORAGER_TRY(begin_transfer());
      return std::optional<HttpResponse>();
    }
    if (code != CURLE_OK) return failure_of(code, static_cast<int>(os_error));
    if (status == 401) return wrong_credentials(static_cast<unsigned long>(schemes));
    if ((static_cast<unsigned long>(schemes) & CURLAUTH_DIGEST) != 0) challenged_ = true;
    return std::optional(HttpResponse{static_cast<int>(status), std::move(body_)});
  }

  Failure wrong_credentials(unsigned long schemes) const {
    if (!credentials_)
      return fail(ErrorCode::authentication, name_, operation_, "the device wants a user and a password",
                  "Give them in the board file");
    if ((schemes & CURLAUTH_DIGEST) == 0)
      return fail(ErrorCode::authentication, name_, operation_, "the device does not offer Digest",
                  "Switch Digest on in the device");
    return fail(ErrorCode::authentication, name_, operation_,
                fmt::format("the device refused user '{}'", credentials_->user),
                "Correct the user or the password in the board file");
  }

  Failure failure_of(CURLcode code, int os_error) const {
    const char* text = curl_easy_strerror(code);
    switch (code) {
      case CURLE_COULDNT_RESOLVE_HOST:
        return fail(ErrorCode::not_present, name_, operation_, "the host name does not resolve",
                    "Check the spelling, or give the numeric address");
      case CURLE_COULDNT_CONNECT:
        // libcurl keeps no errno of some failed connects; a refusal is by far the commonest.
        return socket_failure(name_, operation_, os_error != 0 ? os_error : ECONNREFUSED);
      case CURLE_OPERATION_TIMEDOUT:
        return fail(ErrorCode::timeout, name_, operation_, text,
                    "Check power, cable and address of the device");
      case CURLE_GOT_NOTHING:
      case CURLE_SEND_ERROR:
      case CURLE_RECV_ERROR:
      case CURLE_PARTIAL_FILE:
        return fail(ErrorCode::disconnected, name_, operation_, text, {}, os_error);
      case CURLE_URL_MALFORMAT:
        return fail(ErrorCode::invalid_argument, name_, operation_, text,
                    "Correct the address in the board file");
      case CURLE_WRITE_ERROR:
        return fail(ErrorCode::protocol, name_, operation_, "the answer is larger than 16 MiB");
      case CURLE_UNSUPPORTED_PROTOCOL:
      case CURLE_WEIRD_SERVER_REPLY:
      case CURLE_BAD_CONTENT_ENCODING:
        return fail(ErrorCode::protocol, name_, operation_, text, "Check that this port speaks HTTP");
      default:
        return fail(ErrorCode::io, name_, operation_, text, {}, os_error);
    }
  }

  void do_cancel() override { end_transfer(); }

  // Removing a handle with a transfer under way also closes its connection: no late answer is misread.
  void end_transfer() {
    if (std::exchange(in_flight_, false)) (void)curl_multi_remove_handle(multi_.get(), easy_.get());
  }

  std::string_view do_name() const override { return name_; }

  std::string base_url_;
  std::optional<HttpCredentials> credentials_;
  std::string name_;
  std::string operation_;
  std::string body_;
  bool in_flight_ = false;
  bool challenged_ = false;  // the server has asked for a digest before
  Deadline deadline_;
  Duration timeout_{};
  // Destroyed in reverse: the easy handle before the multi handle that pooled its connections.
  std::unique_ptr<CURLM, MultiDeleter> multi_;
  std::unique_ptr<curl_slist, ListDeleter> headers_;
  std::unique_ptr<CURL, EasyDeleter> easy_;
};

}  // namespace

std::unique_ptr<HttpClient> make_curl_http_client(std::string base_url,
                                                  std::optional<HttpCredentials> credentials) {
  return std::make_unique<CurlHttpClient>(std::move(base_url), std::move(credentials));
}

}  // namespace forager::hal
